"""Does a wider model predict held-out data better, by more than chance?

The two models' held-out squared errors are compared row by row; the differences are summed
over contiguous batches longer than their memory, so that the t statistic stands up to
autocorrelation. Held-out errors already charge for fitted parameters and for the search.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from stribeck.fit import Fit
from stribeck.identify.covariance import batches, correlation_length

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Comparison:
    """Held-out squared error of one model against another's, on the same rows.

    Attributes
    ----------
    fall : float
        Relative fall of the held-out RMSE, on the rows that are fitted to.
    statistic, p_value : float
        t of the mean difference, and its one-sided probability under "no better".
    """

    fall: float
    difference: float
    error: float
    statistic: float
    p_value: float


def compare_squares(before: Array, after: Array, segment: NDArray[np.intp]) -> Comparison:
    """Compare held-out residuals [m] of two models on the same rows."""
    square_before, square_after = before**2, after**2
    change = square_before - square_after
    level = float(np.sqrt(square_before.mean()))
    fall = 1.0 - float(np.sqrt(square_after.mean())) / level if level > 0 else 0.0
    batch = batches(segment, correlation_length(change, segment), fewest=20, most=100)
    count = int(batch.max()) + 1
    if count < 3 or change.size < 3:
        return Comparison(fall, float(change.sum()), np.inf, 0.0, 1.0)
    sums = np.bincount(batch, change, count)
    error = float(np.sqrt(count) * sums.std(ddof=1))
    total = float(sums.sum())
    statistic = total / error if error > 0 else (np.inf if total > 0 else 0.0)
    return Comparison(
        fall, total, error, float(statistic), float(student.sf(statistic, count - 1))
    )


def compare_fits(before: Fit, after: Fit) -> Comparison:
    """How much better `after` predicts the held-out rows that both are fitted to."""
    rows = before.rows
    return compare_squares(
        before.held_out_residual[rows],
        after.held_out_residual[rows],
        before.recording.segment[rows],
    )
