"""Rule: an effect lowers the error of most samples that it changes.

A least-squares fit follows few samples with a very large error, such as those in which the joint
comes to rest. An effect that stands in for what happens there raises the error elsewhere. One that
is there lowers the error of a sample that it changes by the noise in seven of ten.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number
from stribeck.identify.loss import robust_scale

#: Share of the samples changed by more than the noise whose error must fall.
MOST = 0.5
#: Fewer samples show no share.
FEWEST = 20


def worsened(claim: Claim) -> str | None:
    """In what share of the samples that an effect changes the error rises; None where in few."""
    before, along = (
        np.abs(fit.held_out_residual[claim.rows]) for fit in (claim.before, claim.after)
    )
    change = np.abs((claim.after.prediction - claim.before.prediction)[claim.rows])
    changed = change > robust_scale(along)
    if np.count_nonzero(changed) < FEWEST:
        return None
    falls = float(np.mean(along[changed] < before[changed]))
    if falls >= MOST:
        return None
    return (
        f"of the samples that it changes by more than the noise it raises the error of "
        f"{number(100.0 * (1.0 - falls), 2)} %: a few with a very large error decide"
    )
