"""Does a wider model predict better, by more than chance?

Two questions. How much does the error fall on held-out blocks? And could the torque that the
wider model adds have come from the noise alone? The second is a Wald test along the added
torque, with the noise's variance in that direction from batches longer than its memory, so that
it stands up to autocorrelation and to noise that is not the same everywhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.identify.covariance import batches, correlation_length
from stribeck.identify.figures import bridged, rms, zero_phase

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Evidence:
    """What speaks for a wider model.

    Attributes
    ----------
    fall : float
        Relative fall of the held-out RMSE, on the rows that are fitted to.
    everywhere : bool
        Whether the error falls without the block that gains most: not a single event.
    fall_in_band : float
        The same in the band of the motion, where friction acts and vibration does not.
    p_value : float
        Probability of added torque this large if noise were all there is to explain, times the
        number of forms that were guessed at; above 1 it means nothing but "by chance".
    """

    fall: float
    everywhere: bool
    fall_in_band: float
    p_value: float


def evidence(before: Fit, after: Fit) -> Evidence:
    """Weigh a wider fit `after` against `before`."""
    r, rows = before.recording, before.rows
    square_before = before.held_out_residual[rows] ** 2
    square_after = after.held_out_residual[rows] ** 2
    gain = np.bincount(r.block[rows], square_before - square_after)
    level = float(square_before.mean())
    fall = 1.0 - float(np.sqrt(square_after.mean() / level)) if level > 0 else 0.0
    slow_before = zero_phase(r, bridged(r, before.held_out_residual))[rows]
    slow_after = zero_phase(r, bridged(r, after.held_out_residual))[rows]
    added = (after.prediction - before.prediction)[rows]
    return Evidence(
        fall,
        bool(gain.sum() - gain.max() > 0),
        1.0 - rms(slow_after) / (rms(slow_before) or 1.0),
        added_torque_test(
            added,
            after.residual[rows],
            len(after.model.names) - len(before.model.names),
        )
        * _guesses(before, after),
    )


def _guesses(before: Fit, after: Fit) -> int:
    """From how many forms the wider model was chosen by looking at the data, such as periods."""
    added = [e for e in after.model.effects if e not in before.model.effects]
    return math.prod(of_catalog(effect).forms(after.recording) for effect in added)


def added_torque_test(added: Array, residual: Array, parameters: int) -> float:
    """Probability that noise like `residual` alone makes `added` torque [m] this large.

    `added` is the best of a family with so many more `parameters`, nonlinear ones counted like
    the others: that pays for their search.
    """
    size = float(added @ added)
    if size <= 0 or parameters < 1:
        return 1.0
    batch = batches(residual.size, correlation_length(residual), fewest=20, most=200)
    count = int(batch.max()) + 1
    if count <= parameters + 1:
        return 1.0
    scores = np.bincount(batch, added * residual, count)
    variance = float(np.sum((scores - scores.mean()) ** 2)) * count / (count - 1)
    if variance <= 0:
        return 0.0
    return float(
        scipy.special.fdtrc(parameters, count - parameters, size**2 / variance / parameters)
    )


@dataclass(frozen=True)
class Difference:
    """Mean difference of two models' held-out squared errors, and its standard error."""

    total: float
    error: float

    @property
    def statistic(self) -> float:
        """Standard errors by which the first model is worse."""
        if self.total <= 0:
            return 0.0
        return self.total / self.error if self.error > 0 else np.inf


def difference(worse: Fit, better: Fit) -> Difference:
    """Compare two models that need not contain one another, on held-out rows."""
    rows = worse.rows
    change = worse.held_out_residual[rows] ** 2 - better.held_out_residual[rows] ** 2
    batch = batches(change.size, correlation_length(change), fewest=20, most=100)
    count = int(batch.max()) + 1
    sums = np.bincount(batch, change, count)
    error = float(np.sqrt(count) * sums.std(ddof=1)) if count > 2 else np.inf
    return Difference(float(sums.sum()), error)
