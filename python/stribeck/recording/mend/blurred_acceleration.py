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
from stribeck.recording.derive import Smoother
from stribeck.recording.mend.torque_left import REACH, left_of, shifted
from stribeck.recording.motion.any_friction import AnyFriction
from stribeck.recording.rows import noise_level

__all__ = ["followed_filter"]

#: Cut-offs that are tried, as shares of the usual one.
_SHARES = (1.0, 0.7, 0.5)
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
) -> AccelerationFilter:
    """The filter of the acceleration that the torque follows clearly best; the usual one otherwise.

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
    rows = np.flatnonzero(moving)
    if usual.cutoff is None or rows.size < _FEWEST * len(friction.columns(None)):
        return usual
    rows = rows[:: -(-rows.size // _ROWS)]
    targets = shifted(torque, known.segment, rows)

    def left(candidate: AccelerationFilter) -> Floats:
        return left_of(targets, friction.columns(candidate.derived(known)), rows)

    by_usual, best, least = left(usual), usual, (1.0 - _LEAST) ** 2
    for candidate in _candidates(known, usual.cutoff, still, moving):
        by_it = left(candidate)
        ratio = max(_ratio(by_it[REACH], by_usual[REACH]), _ratio(by_it.min(), by_usual.min()))
        if ratio < least:
            best, least = candidate, ratio
    return best


def _candidates(
    known: Derivable, usual: float, still: float, moving: Bools
) -> list[AccelerationFilter]:
    """Lower cut-offs that remove noise, and these and the usual one over each motion by itself."""
    shares = [share for share in _SHARES if _removes_noise(known, usual, share, still, moving)]
    over_all = [AccelerationFilter(share * usual) for share in shares if share < 1.0]
    return [*over_all, *(AccelerationFilter(share * usual, usual, still) for share in shares)]


def _removes_noise(
    known: Derivable, usual: float, share: float, still: float, moving: Bools
) -> bool:
    """Whether at least half of what a lower cut-off removes is noise, away from jumps.

    White noise of density ``2 noise^2 period`` times ``(2 pi f)^(2 derivative)`` between both
    cut-offs.
    """
    if share == 1.0:
        return True
    time, segment, lower = known.time, known.segment, share * usual
    high, low = (
        Smoother(time, segment, cutoff).smooth(known.source, known.derivative)
        for cutoff in (usual, lower)
    )
    away = moving & (known.motions(still).to_end() > 1.0 / lower)
    if not away.any():
        return False
    power = 2 * known.derivative + 1
    density = 2.0 * noise_level(time, known.source, segment) ** 2 * float(np.median(np.diff(time)))
    noise = density * (2.0 * np.pi) ** (power - 1) * (usual**power - lower**power) / power
    return float(np.mean((high - low)[away] ** 2)) <= _REMOVED * noise


def _ratio(square: float, of: float) -> float:
    return float(square / of) if of > 0.0 else np.inf
