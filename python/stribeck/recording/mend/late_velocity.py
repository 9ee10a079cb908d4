"""A recorded velocity that is late: where the torque follows the position, that gives the velocity.

Drives report a velocity behind a low-pass filter. Such a velocity changes its sign after the joint
does, so that every friction model is wrong by twice the dry friction in between, and what is added
to it imitates the filter. The position has no such lag. A torque may be late too, by a delay of
its own: each motion is also compared with the torque at the shift that suits it best.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.consistency.follow import Track, follows
from stribeck.recording.consistency.remedy import PHASE
from stribeck.recording.joint.channels import Channels
from stribeck.recording.mend.torque_left import REACH, left_of, shifted, torque_of
from stribeck.recording.motion.velocity_lag import velocity_lag

__all__ = ["Moved", "late", "note", "torque_follows"]

#: Lag in samples below which the velocity is kept: that of a difference of two positions. What
#: viscous friction does in a longer time looks like inertia.
_LEAST = 0.5
#: Largest deviation from one of the ratio of both: beyond it, the units contradict each other.
_RATIO = 0.05
#: Share of the usual speed below which a joint is at rest, and the quantile that is usual.
_AT_REST, _USUAL = 3e-3, 0.95


@dataclass(frozen=True)
class Moved:
    """Velocity and acceleration, [n] each, of one origin."""

    velocity: Floats
    acceleration: Floats


def late(data: Channels, segment: Ints, period: float) -> float | None:
    """How late the recorded velocity is, s; None where that is less than half a sample.

    Nor where both are not the same motion, where there is no position, or with ``trust``.

    Parameters
    ----------
    period
        Median sampling period, s.
    """
    position, velocity = data.values.get("position"), data.values.get("velocity")
    if position is None or velocity is None or data.prepared.settings.trust or not period > 0.0:
        return None
    found = velocity_lag(data.values["time"], position, velocity, segment)
    if not found.exceeds(_LEAST * period) or not _agree(data, segment, position, velocity):
        return None
    return found.lag


def _agree(data: Channels, segment: Ints, position: Floats, velocity: Floats) -> bool:
    """Whether the velocity is that of the position in all but its delay."""
    pair = follows(Track(data.values["time"], segment), position, velocity)
    same = pair.resolved and all(pair.seen) and pair.agrees
    return same and abs(pair.ratio - 1.0) <= _RATIO and pair.phase <= PHASE


def torque_follows(
    data: Channels, derived: Moved, recorded: Moved, threshold: float, segment: Ints
) -> bool:
    """Whether the torque follows the `derived` motion more closely than the `recorded` one.

    With the torque as recorded, or each at its own best shift of the torque: a late torque does not
    speak for a late velocity.

    By least squares of Coulomb and viscous friction, inertia, gravity and the load, whose factors
    are free, over the samples at which the joint moves by both: faster than the `threshold` by the
    recorded velocity, and than a small share of the usual speed by the derived one. A filter decays
    long after a stop, and what holds a joint at rest has the direction of the motion before it.
    """
    torque = torque_of(data)
    speeds = np.abs(recorded.velocity)
    slowest = _AT_REST * float(np.quantile(speeds, _USUAL))
    moving = (speeds > threshold) & (np.abs(derived.velocity) > slowest)
    if torque is None or not moving.any():
        return False
    by_derived, by_recorded = (
        _left(data, torque, segment, motion, moving) for motion in (derived, recorded)
    )
    in_time = bool(by_derived[REACH] < by_recorded[REACH])
    return in_time or bool(by_derived.min() < by_recorded.min())


def _left(data: Channels, torque: Floats, segment: Ints, motion: Moved, moving: Bools) -> Floats:
    """Sums of squares that the ordinary model of a motion leaves of the torque, at each shift."""
    q, v = data.values["position"], motion.velocity
    columns = [np.sign(v), v, motion.acceleration, np.sin(q), np.cos(q), np.ones_like(v)]
    if "load_torque" in data.values:
        columns.append(data.values["load_torque"])
    rows = np.flatnonzero(moving)
    return left_of(shifted(torque, segment, rows), columns, rows)


def note(lag: float, period: float) -> str:
    """What a reader has to know of a velocity that is not used."""
    return (
        f"the recorded velocity lags the position by {1e3 * lag:.3g} ms "
        f"({lag / period:.2g} samples), as behind a filter, and the torque follows the position: "
        f"the velocity is not used; to use it as recorded, give {option('trust')}"
    )
