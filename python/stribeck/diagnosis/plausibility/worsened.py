"""Rule: an effect lowers the mean absolute error of the samples that it changes.

A least-squares fit follows few samples with a very large error, such as those in which the joint
comes to rest. An effect that stands in for what happens there raises the error elsewhere. In a mean
of absolute errors the few do not decide.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number
from stribeck.effect.describe import acts_in_shocks
from stribeck.identify.loss import robust_scale

#: Fewer samples show no mean.
FEWEST = 20


def worsened(claim: Claim) -> str | None:
    """By how much the mean absolute error of the samples that an effect changes rises.

    None where it falls, where fewer than `FEWEST` are changed by more than the noise, and of an
    effect that acts in shocks, in which a delay of one sample counts.
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
    rise = float(along[changed].sum() / before[changed].sum()) - 1.0
    if rise <= 0.0:
        return None
    return (
        f"the mean absolute error of the samples that it changes by more than the noise rises by "
        f"{number(100.0 * rise, 2)} %: a few with a very large error decide"
    )
