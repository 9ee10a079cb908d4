"""Which units would make the channels of a motion agree with each other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from stribeck.base.units import Unit, find_unit, known_units
from stribeck.recording.naming.names import CHANNELS

__all__ = ["Source", "best_reading", "named_ratio"]

#: A reading explains a ratio within this share; the closest two ratios of units are 5 % apart
#: (6 rpm against 2 pi).
_CLOSE = 0.02
#: What speaks against a reading; the sum decides between readings.
_CHANGED = {"name": 1.0, "map": 1.0, "suffix": 3.0, "option": 4.0}
_RARE, _RARE_COST = {"mrad", "mrad/s", "cm", "cm/s", "um", "um/s", "in", "m/min", "mm/min"}, 0.4
_CLOCK_COST, _WHOLE_CLOCK, _ODD_RATE, _OTHER_KIND = 0.2, 0.7, 1.5, 0.5
#: Sampling rates of controllers and loggers, Hz.
_RATES = (1.0, 1e5)
_FAMILIES = {
    "angular": {
        "position": ("angle",),
        "velocity": ("angular velocity",),
        "acceleration": ("angular acceleration",),
    },
    "linear": {
        "position": ("length",),
        "velocity": ("linear velocity",),
        "acceleration": ("linear acceleration",),
    },
}

#: Ratios between two units of one quantity: the number, how it and its inverse are written, and
#: what they are.
_NAMED = (
    (180.0 / math.pi, "180/pi", "pi/180", "degrees against radians"),
    (6.0, "6", "1/6", "rpm against degrees per second"),
    (30.0 / math.pi, "30/pi", "pi/30", "rpm against rad/s"),
    (2.0 * math.pi, "2 pi", "1/(2 pi)", "turns against radians"),
    (360.0, "360", "1/360", "turns against degrees"),
    (60.0, "60", "1/60", "minutes against seconds"),
    (1e3, "1000", "1/1000", "thousandths"),
    (1e6, "1e6", "1e-6", "millionths"),
    (1e9, "1e9", "1e-9", "nanoseconds against seconds"),
)


@dataclass(frozen=True)
class Source:
    """How a channel is read now.

    Attributes
    ----------
    column
        Of the file.
    factor
        SI units per unit of the column.
    dimension
        None: no unit was named.
    stated_by
        ``name`` or ``map``: nothing named the unit; ``suffix`` or ``option``.
    """

    column: str
    factor: float
    dimension: str | None
    stated_by: str


def named_ratio(ratio: float) -> str | None:
    """What a ratio of two units is, or its inverse; None for any other number.

    Examples
    --------
    >>> named_ratio(-1 / 57.29)
    'pi/180, degrees against radians'
    >>> named_ratio(1.3) is None
    True
    """
    size = abs(ratio)
    for known, written, inverse, what in _NAMED:
        if abs(size / known - 1.0) < _CLOSE:
            return f"{written}, {what}"
        if abs(size * known - 1.0) < _CLOSE:
            return f"{inverse}, {what}"
    return None


def best_reading(
    sources: Mapping[str, Source],
    ratios: Mapping[str, float],
    *,
    rate_hz: float,
    whole_clock: bool,
    joint_kind: str | None,
) -> dict[str, str] | None:
    """The units, by column, under which every rate is the derivative that it should be.

    Parameters
    ----------
    sources
        ``time`` and the channels of motion that are compared.
    ratios
        ``velocity``: d(position)/dt over the velocity as read; ``acceleration``: d(velocity)/dt
        over the acceleration as read.
    rate_hz, whole_clock
        Sampling rate as read; whether every time stamp is a whole number.
    joint_kind
        Where it was given.

    Returns
    -------
    dict or None
        Column -> unit for what has to change; None where no units explain the ratios.
    """
    found: list[tuple[float, dict[str, str]]] = []
    for family in _families(sources, joint_kind):
        extra = _OTHER_KIND if family == "linear" and joint_kind is None else 0.0
        options = [_options(channel, sources[channel], family) for channel in sources]
        for units in itertools.product(*options):
            chosen = dict(zip(sources, units, strict=True))
            misfit = _misfit(chosen, sources, ratios)
            if misfit is None:
                continue
            changed = {
                sources[c].column: unit.name
                for c, unit in chosen.items()
                if unit is not None and unit.factor != sources[c].factor
            }
            if family == "linear":
                _state_linear(chosen, sources, changed)
            cost = misfit + extra * _assumed(sources) + _cost(chosen, sources, rate_hz, whole_clock)
            found.append((cost, changed))
    return min(found, key=lambda pair: pair[0])[1] if found else None


def _families(sources: Mapping[str, Source], joint_kind: str | None) -> Sequence[str]:
    """Angular or linear units, or both where nothing decides."""
    stated = [s.dimension for c, s in sources.items() if c != "time" and s.dimension is not None]
    if any(d.startswith(("length", "linear")) for d in stated) or joint_kind == "prismatic":
        return ("linear",)
    if stated or joint_kind == "revolute":
        return ("angular",)
    return ("angular", "linear")


def _assumed(sources: Mapping[str, Source]) -> bool:
    return all(s.dimension is None for c, s in sources.items() if c != "time")


def _options(channel: str, source: Source, family: str) -> list[Unit | None]:
    """Units that a channel may have; None first: as it is."""
    dimensions = CHANNELS[channel] if channel == "time" else _FAMILIES[family][channel]
    names = [n for n in known_units(dimensions) if n not in ("min", "h")]
    units = [unit for unit in (find_unit(n, dimensions) for n in names) if unit is not None]
    return [None, *(u for u in units if u.factor != source.factor)]


def _gain(unit: Unit | None, source: Source) -> float:
    return 1.0 if unit is None else unit.factor / source.factor


def _misfit(
    chosen: Mapping[str, Unit | None], sources: Mapping[str, Source], ratios: Mapping[str, float]
) -> float | None:
    """How far the ratios are from one, over what counts as close; None where one is not close."""
    gain = {channel: _gain(unit, sources[channel]) for channel, unit in chosen.items()}
    total = 0.0
    for rate, of in (("velocity", "position"), ("acceleration", "velocity")):
        if rate in ratios:
            now = abs(ratios[rate]) * gain[of] / (gain[rate] * gain["time"])
            off = abs(math.log(now)) / _CLOSE
            if off > 1.0:
                return None
            total += 0.1 * off
    return total


def _cost(
    chosen: Mapping[str, Unit | None],
    sources: Mapping[str, Source],
    rate_hz: float,
    whole_clock: bool,
) -> float:
    """What speaks against a reading."""
    total = 0.0
    for channel, unit in chosen.items():
        if unit is not None:
            total += _CHANGED[sources[channel].stated_by]
            total += _RARE_COST * (unit.name in _RARE) + _CLOCK_COST * (channel == "time")
    rate = rate_hz / _gain(chosen["time"], sources["time"])
    total += _ODD_RATE * (not _RATES[0] <= rate <= _RATES[1])
    return total + _WHOLE_CLOCK * (chosen["time"] is None and whole_clock)


def _state_linear(
    chosen: Mapping[str, Unit | None], sources: Mapping[str, Source], changed: dict[str, str]
) -> None:
    """State the SI units too where nothing else says that the joint slides."""
    if changed and not _assumed(sources):
        return
    for channel in _without_time(chosen):
        if chosen[channel] is None and changed:
            unit = find_unit({"position": "m", "velocity": "m/s"}.get(channel, "m/s2"))
            if unit is not None:
                changed.setdefault(sources[channel].column, unit.name)


def _without_time(channels: Iterable[str]) -> list[str]:
    return [channel for channel in channels if channel != "time"]
