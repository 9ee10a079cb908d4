"""An acceleration whose low-pass blurs its jumps, or leaves too much noise: the torque decides.

Dry friction stops a joint at once, and the acceleration jumps. A low-pass across that instant is
wrong there by the inertia times the jump, which a delay or a lag of friction imitates. Noise that a
low-pass leaves is as wrong everywhere, and what averages two samples then lowers the error. Neither
the cut-off nor the jumps can be told from the motion alone; what the motor had to give tells both.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stribeck.recording.acceleration_filter import AccelerationFilter
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.joint.channels import Channels
from stribeck.recording.mend.torque_left import REACH, left_of, shifted, torque_of
from stribeck.recording.motion.any_friction import AnyFriction

__all__ = ["followed_filter"]

#: Cut-offs that are tried, as shares of the usual one. Lower ones remove motion, which the torque
#: of a joint with an elastic drive train does not follow either.
_SHARES = (1.0, 0.7, 0.5)
#: Least relative fall of the RMS that is left, as recorded and at the best shift of the torque.
_LEAST = 0.05
#: Most samples looked at.
_ROWS = 20_000


def followed_filter(
    data: Channels,
    segment: Ints,
    usual: AccelerationFilter,
    still: float,
    derived: Callable[[AccelerationFilter], Floats],
    friction: AnyFriction,
    moving: Bools,
) -> AccelerationFilter:
    """The filter of the acceleration that the torque follows clearly best; the usual one otherwise.

    By least squares of a flexible friction model, the rigid body and the load over the samples that
    move, so that no friction decides.

    Parameters
    ----------
    usual
        The filter that follows from the motion.
    still
        Speed below which the joint rests.
    derived
        The acceleration behind a filter, [n].
    """
    torque, rows = torque_of(data), np.flatnonzero(moving)
    if usual.cutoff is None or torque is None or rows.size < 2:
        return usual
    rows = rows[:: -(-rows.size // _ROWS)]
    targets = shifted(torque, segment, rows)

    def left(candidate: AccelerationFilter) -> Floats:
        return left_of(targets, friction.columns(derived(candidate)), rows)

    by_usual, best, least = left(usual), usual, (1.0 - _LEAST) ** 2
    for candidate in _candidates(usual.cutoff, still):
        by_it = left(candidate)
        ratio = max(_ratio(by_it[REACH], by_usual[REACH]), _ratio(by_it.min(), by_usual.min()))
        if ratio < least:
            best, least = candidate, ratio
    return best


def _candidates(usual: float, still: float) -> list[AccelerationFilter]:
    lower = [share * usual for share in _SHARES]
    over_all = [AccelerationFilter(cutoff) for cutoff in lower[1:]]
    return [*over_all, *(AccelerationFilter(cutoff, usual, still) for cutoff in lower)]


def _ratio(square: float, of: float) -> float:
    return float(square / of) if of > 0.0 else np.inf
