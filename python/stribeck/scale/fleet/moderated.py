"""Test whether means of few days differ; the scatter between days is estimated from many joints.

A joint has a handful of days before and after, too few to know how much they scatter; but there
are many joints. Their scatters are taken as draws around a common one, and each joint's own is
moved towards it by as much as that is worth (Smyth 2004, "Linear models and empirical Bayes methods
for assessing differential expression", section 6).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Smallest number of joints with several days to estimate a common scatter.
FEWEST_JOINTS = 3
#: Smallest number of joints with single days to estimate it; most joints are unchanged.
FEWEST_CHANGES = 5
#: Median of the absolute value of a standard normal variable.
MEDIAN_NORMAL = 0.6745


@dataclass(frozen=True)
class Difference:
    """Weighted means of two groups of days, and their standard errors.

    Attributes
    ----------
    stderr
        Of `after` - `before`, by the standard errors of the days alone.
    ratio
        Birge's: mean square of the days about the mean of their group over their variances; NaN
        where there is one day each.
    freedom
        Degrees of freedom of `ratio`.
    """

    before: float
    after: float
    stderr: float
    ratio: float
    freedom: int

    @property
    def change(self) -> float:
        """After minus before."""
        return self.after - self.before


@dataclass(frozen=True)
class Scatter:
    """What joints have in common: `ratio` scatters around it like one of `freedom` degrees."""

    ratio: float = 1.0
    freedom: float = 0.0


def difference(before: Array, after: Array, error_before: Array, error_after: Array) -> Difference:
    """Compare values [n] and [m] with standard errors, each day one."""
    groups = [(before, error_before**-2.0), (after, error_after**-2.0)]
    means = [float(np.average(values, weights=weights)) for values, weights in groups]
    spread = sum(
        float(weights @ (values - mean) ** 2)
        for (values, weights), mean in zip(groups, means, strict=True)
    )
    freedom = before.size + after.size - 2
    stderr = math.sqrt(sum(1.0 / float(weights.sum()) for _, weights in groups))
    ratio = spread / freedom if freedom else math.nan
    return Difference(means[0], means[1], stderr, ratio, freedom)


def common_scatter(differences: Sequence[Difference]) -> Scatter:
    """Estimate the scatter common to the joints; 0 degrees of freedom if they are too few.

    With one day in each period the days of a joint say nothing of it. Then the changes themselves
    do, of which most are taken to be none (Efron 2004, the empirical null).
    """
    known = [d for d in differences if d.freedom > 0 and d.ratio > 0.0]
    if len(known) < FEWEST_JOINTS:
        return _scatter_of_changes(differences)
    half = np.array([0.5 * d.freedom for d in known])
    logs = np.log([d.ratio for d in known]) - scipy.special.digamma(half) + np.log(half)
    mean = float(logs.mean())
    excess = float(np.var(logs, ddof=1) - np.mean(scipy.special.polygamma(1, half)))
    if excess <= 0.0:
        return Scatter(math.exp(mean), math.inf)
    freedom = 2.0 * _inverse_trigamma(excess)
    ratio = math.exp(mean + float(scipy.special.digamma(0.5 * freedom)) - math.log(0.5 * freedom))
    return Scatter(ratio, freedom)


def _scatter_of_changes(differences: Sequence[Difference]) -> Scatter:
    if len(differences) < FEWEST_CHANGES or any(d.freedom for d in differences):
        return Scatter()
    middle = float(np.median([abs(d.change) / d.stderr for d in differences]))
    return Scatter((middle / MEDIAN_NORMAL) ** 2, len(differences) - 1.0)


def moderated(found: Difference, common: Scatter) -> tuple[float, float]:
    """Return the standard error of a change with scatter between days, and degrees of freedom.

    Never less than what the standard errors of the days say by themselves. Where nothing is known
    of the scatter, these alone count, with infinitely many degrees of freedom.
    """
    freedom = found.freedom + common.freedom
    if freedom == 0:
        return found.stderr, math.inf
    if math.isinf(freedom):
        ratio = common.ratio
    else:
        own = found.freedom * found.ratio if found.freedom else 0.0
        ratio = (own + common.freedom * common.ratio) / freedom
    return found.stderr * math.sqrt(max(ratio, 1.0)), freedom


def two_sided(change: float, stderr: float, freedom: float) -> float:
    """Probability that chance alone gives a change at least as large either way."""
    if stderr <= 0.0:
        return 1.0 if change == 0.0 else 0.0
    return float(2.0 * scipy.special.stdtr(min(freedom, 1e9), -abs(change) / stderr))


def false_discovery(p_values: Sequence[float]) -> list[float]:
    """Benjamini and Hochberg's adjusted p values, in the order given."""
    p = np.asarray(p_values, dtype=np.float64)
    order = np.argsort(p, kind="stable")
    stepped = p[order] * p.size / np.arange(1, p.size + 1)
    adjusted = np.empty_like(p)
    adjusted[order] = np.minimum(np.minimum.accumulate(stepped[::-1])[::-1], 1.0)
    return [float(x) for x in adjusted]


def _inverse_trigamma(value: float) -> float:
    """The x > 0 with trigamma(x) = `value`."""
    # trigamma lies between 1/x and 1/x + 1/x^2.
    high = 0.5 / value + math.sqrt(0.25 / value**2 + 1.0 / value)
    return float(
        scipy.optimize.brentq(
            lambda x: float(scipy.special.polygamma(1, x)) - value,
            1.0 / value * 0.999,
            high * 1.001,
        )
    )
