"""A recorded velocity that is late: the velocity is then derived from the position.

Drives report a velocity behind a low-pass filter. Such a velocity changes its sign after the joint
does, so that every friction model is wrong by twice the dry friction in between, and what is added
to it imitates the filter. The position has no such lag.
"""

from __future__ import annotations

from stribeck.base.errors import option
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.channels import Channels
from stribeck.recording.consistency.follow import Track, follows
from stribeck.recording.consistency.remedy import PHASE
from stribeck.recording.velocity_lag import velocity_lag

__all__ = ["is_late"]

#: Lag in samples below which the velocity is kept.
_LEAST = 1.0
#: Largest deviation from one of the ratio of both: beyond it, the units contradict each other.
_RATIO = 0.05


def is_late(data: Channels, segment: Ints, period: float) -> bool:
    """Whether the recorded velocity is that of the position, but late by more than a sample.

    It is noted. With ``trust``, the velocity is used as recorded.

    Parameters
    ----------
    period
        Median sampling period, s.
    """
    position, velocity = data.values.get("position"), data.values.get("velocity")
    if position is None or velocity is None or data.prepared.settings.trust or not period > 0.0:
        return False
    found = velocity_lag(data.values["time"], position, velocity, segment)
    if not found.exceeds(_LEAST * period) or not _agree(data, segment, position, velocity):
        return False
    data.notes.append(
        f"the recorded velocity lags the position by {1e3 * found.lag:.3g} ms "
        f"({found.lag / period:.2g} samples), as behind a filter, and is not used; to use it as "
        f"recorded, give {option('trust')}"
    )
    return True


def _agree(data: Channels, segment: Ints, position: Floats, velocity: Floats) -> bool:
    """Whether the velocity is that of the position in all but its delay."""
    pair = follows(Track(data.values["time"], segment), position, velocity)
    same = pair.resolved and all(pair.seen) and pair.agrees
    return same and abs(pair.ratio - 1.0) <= _RATIO and pair.phase <= PHASE
