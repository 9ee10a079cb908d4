"""What to do where a rate is not the derivative that it should be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats
from stribeck.recording.consistency.dissipation import dissipation
from stribeck.recording.consistency.follow import Follows, follows
from stribeck.recording.consistency.readings import best_reading, named_ratio
from stribeck.recording.consistency.view import View
from stribeck.recording.tables.cells import column_numbers

__all__ = ["PHASE", "Pair", "agreement", "other_column", "ratio_text", "scale_remedy"]

#: A scale of the velocity that is wrong by less leaves every finding as it is. An acceleration is
#: often the planned one, or filtered; the identified inertia takes up its scale.
SCALE = {"velocity": 0.05, "acceleration": 0.2}
#: A rate may be behind by this angle of the motion: filters of drives delay by less.
PHASE = 0.3
#: Whole numbers this close to a ratio are named as a gear ratio.
_GEAR = 0.002
#: No gear has a smaller ratio: rather, the velocity is an estimate of its own.
_LEAST_GEAR = 1.5
#: Another column is proposed if it has at least this share of common variance.
_MATCH = 0.99
_UNITS = {"velocity": "d(position)/dt", "acceleration": "d(velocity)/dt"}


@dataclass(frozen=True)
class Pair:
    """A rate and the channel that it should be the derivative of.

    Attributes
    ----------
    rate, of
        ``velocity`` of ``position``, or ``acceleration`` of ``velocity``.
    """

    rate: str
    of: str
    found: Follows

    @property
    def derivative(self) -> str:
        """The derivative as sentences write it."""
        return _UNITS[self.rate]

    @property
    def scaled_right(self) -> bool:
        """Whether the ratio is one, up to its interval and the tolerance."""
        size, limit = abs(self.found.ratio), 1.0 + SCALE[self.rate]
        return 1.0 / limit - self.found.error <= size <= limit + self.found.error


def agreement(pair: Pair) -> str:
    """A rate that is the derivative, in one sentence."""
    found = pair.found
    off = max(abs(abs(found.ratio) - 1.0), found.error, 1e-4)
    share = f"{100.0 * off:.1g}" if off < 0.095 else f"{100.0 * off:.2g}"
    text = f"{pair.rate} = {pair.derivative} within {share} %"
    if found.lag:
        side = "behind" if found.lag > 0.0 else "ahead of"
        what = "" if found.lag > 0.0 else f" {pair.of}"
        text += f", {abs(found.lag):.2g} s {side}{what}"
    return text


def scale_remedy(view: View, pair: Pair) -> str:
    """The units or the factor that make a rate the derivative."""
    pairs = {"velocity": view.velocity, "acceleration": view.acceleration}
    ratios = {
        rate: follow.ratio
        for rate, follow in pairs.items()
        if follow is not None and follow.agrees and follow.ratio
    }
    channels = ("time", "position", "velocity", "acceleration")
    sources = {c: view.source(c) for c in channels if c in view.prepared.choices}
    reading = None
    if "velocity" in sources:
        reading = best_reading(
            sources,
            ratios,
            rate_hz=view.recording.rate_hz,
            whole_clock=view.whole_clock,
            joint_kind=view.prepared.settings.joint_kind,
        )
    if reading:
        given = [f"{column}={unit}" for column, unit in reading.items()]
        return f"the likeliest units are given by {option('unit', *given)}"
    return _factor(view, pair)


def _factor(view: View, pair: Pair) -> str:
    """The formula that removes a factor that is no ratio of units.

    Of a position and a velocity the larger one may be the motor's; which of them is wrong cannot be
    told from the two alone.
    """
    ratio = pair.found.ratio
    size, sign = abs(ratio), "-" if ratio < 0.0 else ""
    if pair.rate == "acceleration":
        return f"give {view.derived('acceleration', f'{sign}{{}}*{_short(size)}')}"
    gear = abs(view.prepared.settings.mechanics.gear_ratio)
    large, small = ("position", "velocity") if size > 1.0 else ("velocity", "position")
    factor = max(size, 1.0 / size)
    if gear != 1.0 and abs(factor / gear - 1.0) < SCALE["velocity"]:
        why, factor = f"the {large} is the motor's, {gear:g} times the joint's", gear
    else:
        if abs(factor / round(factor) - 1.0) < _GEAR:
            factor = float(round(factor))
        why = f"if the {large} is the motor's, {_short(factor)} is the gear ratio"
        if factor < _LEAST_GEAR:
            leave_out = option("map", "velocity=none")
            why = f"give {leave_out}, which derives it from the position; {why}"
    return (
        f"{why}: give {view.derived(large, f'{sign}{{}}/{_short(factor)}')}; otherwise give "
        f"{view.derived(small, f'{sign}{{}}*{_short(factor)}')}"
    )


def _short(number: float) -> str:
    return f"{number:.6g}"


def ratio_text(ratio: float) -> str:
    """A ratio, and what it is if it is a known one."""
    known = named_ratio(ratio)
    return f"{abs(ratio):.4g} times" + (f" ({known})" if known else "")


def other_column(view: View, pair: Pair) -> str | None:
    """The option that maps the column that fits the motion, where the file has one.

    A rate and its channel may be of two joints. Which of them is the odd one is decided by the
    torque: the motion that explains more of it is the joint's.
    """
    x, rate = view.recorded(pair.of), view.recorded(pair.rate)
    if x is None or rate is None:
        return None
    if pair.rate == "velocity" and not _own_motion(view, rate, x):
        best = _best(view, lambda values: follows(view.track, values, rate), pair.of)
        if best is not None:
            return option("map", f"{pair.of}={best}")
    best = _best(view, lambda values: follows(view.track, x, values), pair.rate)
    return None if best is None else option("map", f"{pair.rate}={best}")


def _own_motion(view: View, velocity: Floats, position: Floats) -> bool:
    """Whether the torque goes with the velocity less than with the position's derivative."""
    slope = np.gradient(position, view.recording.time)
    first, second = dissipation(view.recording, velocity), dissipation(view.recording, slope)
    if first is None or second is None:
        return True
    return first.explained <= second.explained


def _best(view: View, compare: Callable[[Floats], Follows], channel: str) -> str | None:
    """The unused column of numbers with the most common variance, from the limit on."""
    used = {choice.source for choice in view.prepared.choices.values()}
    prepared, best, most = view.prepared, None, _MATCH
    for name in prepared.table.columns:
        series = prepared.table[name]
        if name in used or not series.dtype.is_float():
            continue
        try:
            values = column_numbers(prepared.source, prepared.table, prepared.row, name)[view.rows]
        except RecordingError:
            continue
        if not np.isfinite(values).all() or np.ptp(values) == 0.0:
            continue
        found = compare(values)
        if found.common > most and all(found.seen) and found.ratio > 0.0:
            best, most = name, found.common
    return best
