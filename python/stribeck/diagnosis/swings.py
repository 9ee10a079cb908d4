"""Friction that swings with something that was not recorded.

Friction changes sign with the direction of motion; noise, however slow, does not. So where the
residual of neighbouring forward and backward motion, each taken in its own direction, rises and
falls together along the recording, friction itself does, and no channel says why.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.fitting.result import Fit

Array = NDArray[np.float64]

#: Stretches that the recording is cut into, and rows a direction needs in each to count.
STRETCHES, FEWEST_ROWS, FEWEST_STRETCHES = 80, 10, 8
#: Probability below which an agreement between the directions is not by chance; and where repeats
#: of the same state differ by so much less than the error that something must be missing.
SIGNIFICANCE, SUSPECTED = 1e-3, 1e-2


@dataclass(frozen=True)
class Swings:
    """How far friction swings along a recording for no recorded reason.

    Attributes
    ----------
    rms
        Of what both directions agree on, in the unit of torque; 0 where that may be chance.
    """

    rms: float


def swings(fit: Fit, *, suspected: bool = False) -> Swings:
    """Compare the two directions of motion, stretch by stretch.

    Parameters
    ----------
    suspected : bool
        Whether the noise floor says that something is missing.
    """
    rows = fit.rows
    stretch = np.arange(rows.size) * STRETCHES // max(rows.size, 1)
    sign = np.sign(fit.recording.velocity[rows])
    # Of all rows: a drift that a refit without the last tenth foretells badly is no swing.
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
        return Swings(0.0)
    agreement = scipy.stats.pearsonr(forward, backward, alternative="greater")
    if agreement.pvalue > (SUSPECTED if suspected else SIGNIFICANCE):
        return Swings(0.0)
    return Swings(float(np.sqrt(np.cov(forward, backward)[0, 1])))
