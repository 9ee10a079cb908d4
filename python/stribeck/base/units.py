"""Units of measured channels and their conversion to SI (temperature stays in degC).

The table is the crate's (`stribeck._core.units`); here it is looked up by any of its spellings.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from stribeck import _core
from stribeck.base.errors import RecordingError, nearest

__all__ = [
    "ABSOLUTE_ZERO",
    "CHANNEL_POWERS",
    "SI",
    "Unit",
    "find_unit",
    "known_units",
    "parse_unit",
]


@dataclass(frozen=True)
class Unit:
    """A unit: SI value = factor * value + offset."""

    name: str
    dimension: str
    factor: float
    offset: float = 0.0


_TABLE = _core.units()

#: SI unit of each dimension.
SI: dict[str, str] = {row["name"]: row["si"] for row in _TABLE["dimensions"]}

#: Powers of torque, position, time and temperature in the unit of each channel of a law.
CHANNEL_POWERS: dict[str, tuple[int, int, int, int]] = {
    row["name"]: row["powers"] for row in _TABLE["channels"]
}


def _tidy(text: str) -> str:
    """One spelling for one unit: 'N m', 'N·m', 'N*m' and 'N.m' are all 'Nm'; 's^2' is 's2'."""
    text = text.strip().replace("μ", "µ").replace("²", "2").replace("^", "").replace("**", "")
    text = text.replace("s-2", "s2") if "/" in text else text
    return re.sub(r"[\s·⋅*._-]", "", text)


_EXACT: dict[str, Unit] = {}
_FOLDED: dict[str, list[Unit]] = {}
for _row in _TABLE["units"]:
    _is_si = _row["factor"] == 1.0 and _row["offset"] == 0.0
    # SI units are shown as they are written, 'N m', the others by their first spelling.
    _shown = SI[_row["dimension"]] if _is_si else _row["spellings"][0]
    _unit = Unit(_shown, _row["dimension"], _row["factor"], _row["offset"])
    for _name in _row["spellings"]:
        _EXACT[_tidy(_name)] = _unit
        _FOLDED.setdefault(_tidy(_name).casefold(), []).append(_unit)


#: The lowest temperature, degC.
ABSOLUTE_ZERO = _EXACT["K"].offset


def known_units(dimensions: tuple[str, ...] | None = None) -> list[str]:
    """Return the shown spelling of every unit of the given dimensions (all by default)."""
    names: list[str] = []
    for unit in _EXACT.values():
        if (dimensions is None or unit.dimension in dimensions) and unit.name not in names:
            names.append(unit.name)
    return names


def find_unit(text: str, dimensions: tuple[str, ...] | None = None) -> Unit | None:
    """Return the unit a text spells, or None.

    The exact spelling wins (mN is not MN). Without regard to case a spelling counts only if it is
    that of a single unit of the wanted dimensions.
    """
    key = _tidy(text)
    unit = _EXACT.get(key)
    if unit is not None and (dimensions is None or unit.dimension in dimensions):
        return unit
    same = {
        u
        for u in _FOLDED.get(key.casefold(), [])
        if dimensions is None or u.dimension in dimensions
    }
    return same.pop() if len(same) == 1 else None


def parse_unit(text: str, dimensions: tuple[str, ...], what: str) -> Unit:
    """Return the unit a text spells, or refuse it with a list of the units that fit.

    Parameters
    ----------
    what
        Where the unit was given, for the sentence, e.g. ``"data.csv: column 'vel'"``.
    """
    unit = find_unit(text, dimensions)
    if unit is not None:
        return unit
    known = known_units(dimensions)
    other = find_unit(text)
    if other is not None:
        raise RecordingError(
            f"{what}: '{text}' is a unit of {other.dimension}, not of {' or '.join(dimensions)}: "
            f"use one of {', '.join(known)}"
        )
    hint = nearest(text, known)
    use = f"{hint} Use" if hint else ": use"
    raise RecordingError(f"{what}: unknown unit '{text}'{use} one of {', '.join(known)}")
