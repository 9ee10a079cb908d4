"""An acceleration whose low-pass blurs its jumps, or leaves too much noise: the torque decides.

Dry friction stops a joint at once, and the acceleration jumps. A low-pass across that instant is
wrong there by the inertia times the jump, which a delay or a lag of friction imitates. Noise that a
low-pass leaves is as wrong everywhere, and what averages two samples then lowers the error. Neither
the cut-off nor the jumps can be told from the motion alone; what the motor had to give tells both.
"""

from __future__ import annotations

import numpy as np

from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable
from stribeck.recording.arrays import Bools, Floats
from stribeck.recording.mend.torque_left import REACH, left_of, shifted
from stribeck.recording.motion.any_friction import AnyFriction
from stribeck.recording.motion.derived_motion import filtered_noise
from stribeck.recording.rows import noise_level

__all__ = ["followed_filter"]

#: Lower cut-offs that are tried, as shares of the usual one.
_LOWER = (0.7, 0.5)
#: Least relative fall of the RMS that is left, as recorded and at the best shift of the torque.
_LEAST = 0.05
#: Largest variance that a lower cut-off removes, in variances of the noise: half of it is motion,
#: which the torque of an elastic drive train does not follow either.
_REMOVED = 2.0
#: Fewest samples for each column of the model, and most samples looked at.
_FEWEST, _ROWS = 10, 20_000


def followed_filter(
    known: Derivable,
    torque: Floats,
    usual: AccelerationFilter,
    still: float,
    friction: AnyFriction,
    moving: Bools,
) -> tuple[AccelerationFilter, Floats]:
    """The filter that the torque follows clearly best, or the usual one; its acceleration [n].

    By least squares of a flexible friction model, the rigid body and the load over the samples that
    move, so that no friction decides.

    Parameters
    ----------
    torque
        As recorded, in any unit, [n].
    usual
        The filter that follows from the motion.
    still
        Speed below which the joint rests.
    """
    best, least = (usual, usual.derived(known)), (1.0 - _LEAST) ** 2
    rows = np.flatnonzero(moving)
    if usual.cutoff is None or rows.size < _FEWEST * len(friction.columns(None)):
        return best
    rows = rows[:: -(-rows.size // _ROWS)]
    targets = shifted(torque, known.segment, rows)
    by_usual = left_of(targets, friction.columns(best[1]), rows)
    for candidate in _candidates(known, usual.cutoff, best[1], still, moving):
        acceleration = candidate.derived(known)
        by_it = left_of(targets, friction.columns(acceleration), rows)
        ratio = max(_ratio(by_it[REACH], by_usual[REACH]), _ratio(by_it.min(), by_usual.min()))
        if ratio < least:
            best, least = (candidate, acceleration), ratio
    return best


def _candidates(
    known: Derivable, usual: float, by_usual: Floats, still: float, moving: Bools
) -> list[AccelerationFilter]:
    """Lower cut-offs that remove noise, and these and the usual one over each motion by itself.

    Parameters
    ----------
    by_usual
        The acceleration behind the usual filter, [n].
    """
    noise = noise_level(known.time, known.source, known.segment)
    to_end = known.motions(still).to_end()
    lower = []
    for cutoff in (share * usual for share in _LOWER):
        removed = by_usual - AccelerationFilter(cutoff).derived(known)
        # Beside the end of a motion a jump is removed.
        away = removed[moving & (to_end > 1.0 / cutoff)]
        if away.size and np.mean(away**2) <= _REMOVED * _between(known, noise, cutoff, usual):
            lower.append(cutoff)
    by_motion = (AccelerationFilter(cutoff, usual, still) for cutoff in (usual, *lower))
    return [*(AccelerationFilter(cutoff) for cutoff in lower), *by_motion]


def _between(known: Derivable, noise: float, low: float, high: float) -> float:
    """Variance of the noise of the acceleration between two cut-offs."""
    period = float(np.median(np.diff(known.time)))
    upper, lower = (filtered_noise(noise, period, c, known.derivative) or 0.0 for c in (high, low))
    return upper**2 - lower**2


def _ratio(square: float, of: float) -> float:
    return float(square / of) if of > 0.0 else np.inf
