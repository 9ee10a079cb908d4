"""Units of measured channels and their conversion to SI (temperature stays in degC)."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from stribeck.base.errors import RecordingError, nearest

__all__ = ["SI", "Unit", "find_unit", "known_units", "parse_unit"]


@dataclass(frozen=True)
class Unit:
    """A unit: SI value = factor * value + offset."""

    name: str
    dimension: str
    factor: float
    offset: float = 0.0


SI: dict[str, str] = {
    "time": "s",
    "angle": "rad",
    "length": "m",
    "angular velocity": "rad/s",
    "linear velocity": "m/s",
    "angular acceleration": "rad/s2",
    "linear acceleration": "m/s2",
    "torque": "N m",
    "force": "N",
    "temperature": "degC",
    "current": "A",
    "voltage": "V",
    "percent": "%",
    "number": "1",
}

_TURN = 2.0 * math.pi
_DEG = math.pi / 180.0

# (dimension, spellings, factor, offset); the first spelling is the one shown to the user.
_TABLE: tuple[tuple[str, str, float, float], ...] = (
    ("time", "s sec second seconds", 1.0, 0.0),
    ("time", "ms msec millisecond milliseconds", 1e-3, 0.0),
    ("time", "us usec µs microseconds", 1e-6, 0.0),
    ("time", "ns nsec nanoseconds", 1e-9, 0.0),
    ("time", "min", 60.0, 0.0),
    ("time", "h hour hours", 3600.0, 0.0),
    ("angle", "rad radian radians", 1.0, 0.0),
    ("angle", "mrad", 1e-3, 0.0),
    ("angle", "deg ° degree degrees", _DEG, 0.0),
    ("angle", "rev turn turns revolutions", _TURN, 0.0),
    ("length", "m meter metre meters metres", 1.0, 0.0),
    ("length", "cm", 1e-2, 0.0),
    ("length", "mm", 1e-3, 0.0),
    ("length", "um µm", 1e-6, 0.0),
    ("length", "in inch", 0.0254, 0.0),
    ("angular velocity", "rad/s radps rads rad_per_s radpersec", 1.0, 0.0),
    ("angular velocity", "mrad/s mradps", 1e-3, 0.0),
    ("angular velocity", "deg/s degps dps °/s deg_per_s", _DEG, 0.0),
    ("angular velocity", "rpm rev/min r/min 1/min", _TURN / 60.0, 0.0),
    ("angular velocity", "rev/s revps rps turn/s", _TURN, 0.0),
    ("linear velocity", "m/s mps m_per_s", 1.0, 0.0),
    ("linear velocity", "cm/s cmps", 1e-2, 0.0),
    ("linear velocity", "mm/s mmps mm_per_s", 1e-3, 0.0),
    ("linear velocity", "um/s umps µm/s", 1e-6, 0.0),
    ("linear velocity", "m/min", 1.0 / 60.0, 0.0),
    ("linear velocity", "mm/min mmpmin", 1e-3 / 60.0, 0.0),
    ("angular acceleration", "rad/s2 radps2 rads2 rad_per_s2", 1.0, 0.0),
    ("angular acceleration", "deg/s2 degps2 deg_per_s2 °/s2", _DEG, 0.0),
    ("angular acceleration", "rpm/s rpmps", _TURN / 60.0, 0.0),
    ("linear acceleration", "m/s2 mps2 m_per_s2", 1.0, 0.0),
    ("linear acceleration", "mm/s2 mmps2 mm_per_s2", 1e-3, 0.0),
    ("torque", "Nm N_m newtonmeter", 1.0, 0.0),
    ("torque", "mNm mN_m", 1e-3, 0.0),
    ("torque", "uNm µNm", 1e-6, 0.0),
    ("torque", "kNm", 1e3, 0.0),
    ("torque", "Ncm", 1e-2, 0.0),
    ("torque", "Nmm", 1e-3, 0.0),
    ("torque", "kgfcm kgcm", 9.80665e-2, 0.0),
    ("torque", "kgfm kgm", 9.80665, 0.0),
    ("torque", "ozin ozfin", 7.0615518333e-3, 0.0),
    ("torque", "lbfin lbin inlb", 0.1129848290, 0.0),
    ("torque", "lbfft lbft ftlb", 1.3558179483, 0.0),
    ("force", "N newton", 1.0, 0.0),
    ("force", "mN", 1e-3, 0.0),
    ("force", "kN", 1e3, 0.0),
    ("force", "kgf", 9.80665, 0.0),
    ("force", "lbf", 4.4482216153, 0.0),
    ("temperature", "degC C °C celsius deg_C", 1.0, 0.0),
    ("temperature", "K kelvin", 1.0, -273.15),
    ("temperature", "degF F °F fahrenheit", 5.0 / 9.0, -160.0 / 9.0),
    ("current", "A amp amps ampere", 1.0, 0.0),
    ("current", "mA", 1e-3, 0.0),
    ("voltage", "V volt volts", 1.0, 0.0),
    ("voltage", "mV", 1e-3, 0.0),
    ("percent", "% pct percent", 1.0, 0.0),
    ("percent", "permille ‰", 0.1, 0.0),
    ("number", "1 none", 1.0, 0.0),
)


def _tidy(text: str) -> str:
    """One spelling for one unit: 'N m', 'N·m', 'N*m' and 'N.m' are all 'Nm'; 's^2' is 's2'."""
    text = text.strip().replace("μ", "µ").replace("²", "2").replace("^", "").replace("**", "")
    text = text.replace("s-2", "s2") if "/" in text else text
    return re.sub(r"[\s·⋅*._-]", "", text)


_EXACT: dict[str, Unit] = {}
_FOLDED: dict[str, list[Unit]] = {}
for _dimension, _spellings, _factor, _offset in _TABLE:
    _names = _spellings.split()
    for _name in _names:
        _shown = SI[_dimension] if _factor == 1.0 and _offset == 0.0 else _names[0]
        _unit = Unit(_shown, _dimension, _factor, _offset)
        _EXACT[_tidy(_name)] = _unit
        _FOLDED.setdefault(_tidy(_name).casefold(), []).append(_unit)


def known_units(dimensions: tuple[str, ...] | None = None) -> list[str]:
    """Return the shown spelling of every unit of the given dimensions (all by default)."""
    names: list[str] = []
    for unit in _EXACT.values():
        if (dimensions is None or unit.dimension in dimensions) and unit.name not in names:
            names.append(unit.name)
    return names


def find_unit(text: str, dimensions: tuple[str, ...] | None = None) -> Unit | None:
    """Return the unit a text spells, or None.

    The exact spelling wins (mN is not MN); the spelling without regard to case is taken only when
    a single unit of the wanted dimensions answers to it.
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
    """Return the unit a text spells, or refuse it with the list of those that would do.

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
    raise RecordingError(
        f"{what}: unknown unit '{text}'{nearest(text, known)} Use one of {', '.join(known)}"
        if nearest(text, known)
        else f"{what}: unknown unit '{text}': use one of {', '.join(known)}"
    )
