"""Friction that varies along a recording for no recorded reason.

Friction changes its sign with the direction of motion; slow noise does not. The residual of forward
and of backward motion is multiplied by the sign of the velocity. Where both then rise and fall
together along the recording, friction itself varies, and no channel explains it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.fitting.result import Fit

Array = NDArray[np.float64]

#: Stretches of the recording, samples needed in each per direction, and stretches needed.
STRETCHES, FEWEST_ROWS, FEWEST_STRETCHES = 80, 10, 8
#: Significance level of a correlation between the directions; and the level where the noise floor
#: is so far below the error that something must be missing.
SIGNIFICANCE, SUSPECTED = 1e-3, 1e-2


@dataclass(frozen=True)
class VaryingFriction:
    """How much friction varies along a recording for no recorded reason.

    Attributes
    ----------
    rms
        RMS of the common part of both directions, in the unit of torque; 0 if not significant.
    """

    rms: float


def varying_friction(fit: Fit, *, suspected: bool = False) -> VaryingFriction:
    """Compare the two directions of motion, stretch by stretch.

    Parameters
    ----------
    suspected : bool
        Whether the noise floor shows that something is missing.
    """
    rows = fit.rows
    stretch = np.arange(rows.size) * STRETCHES // max(rows.size, 1)
    sign = np.sign(fit.recording.velocity[rows])
    # Not the held-out residual: a drift that is badly extrapolated to the last block would show.
    higher = fit.residual[rows] * sign
    means = []
    seen = np.ones(STRETCHES, dtype=bool)
    for side in (1.0, -1.0):
        count = np.bincount(stretch, sign == side, STRETCHES)
        total = np.bincount(stretch, np.where(sign == side, higher, 0.0), STRETCHES)
        seen &= count >= FEWEST_ROWS
        means.append(total / np.maximum(count, 1.0))
    forward, backward = means[0][seen], means[1][seen]
    if forward.size < FEWEST_STRETCHES or np.ptp(forward) == 0.0 or np.ptp(backward) == 0.0:
        return VaryingFriction(0.0)
    if _chance(forward, backward) > (SUSPECTED if suspected else SIGNIFICANCE):
        return VaryingFriction(0.0)
    return VaryingFriction(float(np.sqrt(np.cov(forward, backward)[0, 1])))


def _chance(forward: Array, backward: Array) -> float:
    """Probability that independent means correlate at least as much as these, by Student's t."""
    correlation = float(np.corrcoef(forward, backward)[0, 1])
    freedom = forward.size - 2
    if abs(correlation) >= 1.0:
        return 0.0 if correlation > 0.0 else 1.0
    t = correlation * np.sqrt(freedom / (1.0 - correlation**2))
    return float(scipy.special.stdtr(freedom, -t))
