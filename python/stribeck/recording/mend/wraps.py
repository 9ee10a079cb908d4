"""A position that wraps: found by its jumps from one end of its range to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.check import Check
from stribeck.recording.consistency.follow import Track, follows
from stribeck.recording.joint.channels import Channels
from stribeck.recording.rows import segment_rows

__all__ = ["unwrap"]

#: A jump is longer than this share of the range of the position.
_LONG = 0.5
#: Every other step is shorter than this share of it.
_SHORT = 0.25
#: Turns in degrees.
_DEGREES = (360.0, 720.0)
#: Periods that positions wrap with: turns in rad and in degrees, and +-12.5 rad of actuators with
#: a 16-bit position.
_PERIODS = (2.0 * np.pi, 4.0 * np.pi, 8.0 * np.pi, 25.0, *_DEGREES)
#: A measured period within this share of a known one is that one.
_NEAR = 2e-3


@dataclass(frozen=True)
class _Wrap:
    """Jumps of a position.

    Attributes
    ----------
    jump
        The jumps by direction, [n - 1]: 1, -1, and 0 where there is none.
    period
        Length of a jump without the motion in it.
    scatter
        Largest distance of a jump from it.
    usual
        Largest change of the other steps from one to the next.
    """

    jump: Ints
    period: float
    scatter: float
    usual: float

    @property
    def count(self) -> int:
        """Number of jumps."""
        return int(np.count_nonzero(self.jump))

    @property
    def known(self) -> bool:
        """Whether the period is one that positions wrap with."""
        return self.period in _PERIODS

    @property
    def even(self) -> bool:
        """Whether all jumps have one length, as far as the motion lets it be seen."""
        return self.scatter <= 3.0 * self.usual + 1e-9 * self.period


def unwrap(data: Channels, run: Ints, *, mend: bool = True) -> None:
    """Undo the wrapping of the position, with a note that states the period.

    A wrap is certain if all jumps have one length and the velocity, or a known period, or a second
    jump confirms it. An uncertain one is undone with `unwrap=True` alone; otherwise it is a check
    that fails.

    Parameters
    ----------
    mend
        Whether it may be undone; a part of a data set does not know the turns before it.
    """
    settings = data.prepared.settings
    position, time = data.values.get("position"), data.values.get("time")
    if position is None or time is None or settings.average or len(position) < 10:
        return
    segment, _, _ = segment_rows(time, run, data.sequence)
    found = _found(position, segment[1:] == segment[:-1])
    if found is None:
        return
    turned = position.copy()
    turned[1:] -= found.period * np.cumsum(found.jump)
    # The turns are counted from the start of each run.
    for first in np.flatnonzero(np.concatenate([[True], run[1:] != run[:-1]])):
        same = run == run[first]
        turned[same] += position[first] - turned[first]
    times = "1 time" if found.count == 1 else f"{found.count} times"
    jumps = f"the position jumps {times} by {found.period:.6g}"
    choice = data.prepared.choices.get("position")
    if found.period in _DEGREES and choice is not None and choice.unit is None:
        given = option("unit", f"{choice.source}=deg")
        said = f"{jumps}, as one in degrees does, and its unit is not named"
        data.doubts.append(Check("position", False, said, f"give {given}, or its other unit"))
        return
    if mend and (settings.unwrap or _certain(data, Track(time, segment), found, turned)):
        data.values["position"] = turned
        data.notes.append(f"{jumps} and is unwrapped with this period")
        return
    said = f"{jumps}, and it is not certain that it wraps"
    do = f"give {option('unwrap')} if it does, or leave it out with "
    if not mend:
        said = f"{jumps}, and a streamed data set is not unwrapped"
        do = "write the position without jumps, or leave it out with "
    data.doubts.append(Check("position", False, said, do + option("map", "position=none")))


def _found(position: Floats, inside: Floats) -> _Wrap | None:
    """The jumps from one end of the range to the other; None where there are none."""
    span = float(np.ptp(position))
    step = np.where(inside, np.diff(position), 0.0)
    long = np.abs(step) > _LONG * span
    if not long.any() or np.abs(step[~long]).max(initial=0.0) > _SHORT * span:
        return None
    plain = np.where(long, np.nan, step)
    before = np.concatenate([[np.nan], plain[:-1]])
    after = np.concatenate([plain[1:], [np.nan]])
    around = np.nanmean(np.stack([before, after, np.zeros_like(step)])[:2, long], axis=0)
    around = np.nan_to_num(around)
    length = np.abs(step[long] - around)
    period = float(np.median(length))
    near = [known for known in _PERIODS if abs(period / known - 1.0) < _NEAR]
    period = near[0] if near else period
    change = np.abs(np.diff(step))[~(long[1:] | long[:-1])]
    return _Wrap(
        np.where(long, np.sign(step), 0.0).astype(np.int64),
        period,
        float(np.abs(length - period).max()),
        float(change.max(initial=0.0)),
    )


def _certain(data: Channels, track: Track, found: _Wrap, turned: Floats) -> bool:
    velocity = data.values.get("velocity")
    if not found.even:
        return False
    if velocity is not None and velocity.any():
        after, before = (follows(track, x, velocity) for x in (turned, data.values["position"]))
        return after.agrees and after.common > before.common
    return found.known or found.count >= 2
