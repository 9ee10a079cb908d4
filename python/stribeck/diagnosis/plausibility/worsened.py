"""Rule: an effect lowers the mean absolute error of the samples that it changes.

A least-squares fit follows few samples with a very large error, such as those in which the joint
comes to rest. An effect that stands in for what happens there raises the error elsewhere. In a mean
of absolute errors the few do not decide.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.plausibility.claim import Array, Claim
from stribeck.effect.base import number
from stribeck.effect.describe import acts_in_shocks
from stribeck.identify.errors.covariance import batches, correlation_length
from stribeck.identify.stated.loss import robust_scale

#: Fewer samples show no mean.
FEWEST = 20


def worsened(claim: Claim) -> str | None:
    """By how much the mean absolute error of the samples that an effect changes rises.

    None where it falls, or rises by no more than its standard error, where fewer than `FEWEST` are
    changed by more than the noise, and of an effect that acts in shocks, in which a delay of one
    sample counts.
    """
    if acts_in_shocks(claim.effect):
        return None
    before, along = (
        np.abs(fit.held_out_residual[claim.rows]) for fit in (claim.before, claim.after)
    )
    change = np.abs((claim.after.prediction - claim.before.prediction)[claim.rows])
    changed = change > robust_scale(along)
    if np.count_nonzero(changed) < FEWEST:
        return None
    more = (along - before)[changed]
    if float(more.sum()) <= _error_of_sum(more):
        return None
    rise = float(along[changed].sum() / before[changed].sum()) - 1.0
    return (
        f"the mean absolute error of the samples that it changes by more than the noise rises by "
        f"{number(100.0 * rise, 2)} %: a few with a very large error decide"
    )


def _error_of_sum(values: Array) -> float:
    """Standard error of the sum of values [m] that are correlated in time."""
    batch = batches(values.size, correlation_length(values), fewest=FEWEST)
    sums = np.bincount(batch, values)
    return float(np.sqrt(sums.size) * sums.std(ddof=1)) if sums.size > 2 else np.inf
