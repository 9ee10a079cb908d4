"""Test whether means over few days differ, with the scatter between days estimated from all joints.

A joint has few days before and after, too few to estimate their scatter, but there are many joints.
The variances of the joints are assumed to be drawn from a common prior, and each joint's variance
is shrunk towards it (Smyth 2004, "Linear models and empirical Bayes methods for assessing
differential expression", section 6).
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
#: Smallest number of joints with single days to estimate it, assuming that most are unchanged.
FEWEST_CHANGES = 5
#: Median of the absolute value of a standard normal variable.
MEDIAN_NORMAL = 0.6745


@dataclass(frozen=True)
class Difference:
    """Weighted means of two groups of days, and their standard errors.

    Attributes
    ----------
    stderr
        Standard error of `after` - `before`, from the standard errors of the days alone.
    ratio
        Birge ratio: weighted mean square of the deviations of the days from the mean of their
        group, the weights being the inverse variances; NaN with one day in each group.
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
    """Common scatter: the prior of `Difference.ratio`, with `freedom` degrees of freedom."""

    ratio: float = 1.0
    freedom: float = 0.0


def difference(before: Array, after: Array, error_before: Array, error_after: Array) -> Difference:
    """Compare the values [n] and [m] of the days of two groups, given their standard errors."""
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
    """Estimate the scatter common to the joints; 0 degrees of freedom if there are too few joints.

    With one day in each period, the days of a joint do not determine it. It is then estimated from
    the changes, assuming that most joints are unchanged (Efron 2004, the empirical null).
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

    The result is never smaller than the standard error from the days alone. If the scatter is
    unknown, it is equal to that, with infinitely many degrees of freedom.
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
    """Two-sided p-value of a change."""
    if stderr <= 0.0:
        return 1.0 if change == 0.0 else 0.0
    return float(2.0 * scipy.special.stdtr(min(freedom, 1e9), -abs(change) / stderr))


def false_discovery(p_values: Sequence[float]) -> list[float]:
    """P-values adjusted by the method of Benjamini and Hochberg, in the order given."""
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
