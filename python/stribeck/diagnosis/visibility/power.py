"""How large an added torque must be for a diagnosis to see it.

The power of the test in `evidence`: the size at which an effect passes with a given probability,
from the noise of the residual along the torque.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.diagnosis.visibility.held_out import NOTHING_HELD_OUT, HeldOutBalance
from stribeck.identify.errors.covariance import batches, correlation_length

Array = NDArray[np.float64]

#: Allowed ratio of the cost of estimation on held-out blocks to its expected value.
MARGIN = 2.0
#: Probability with which an effect of the stated size is seen.
POWER = 0.95


@dataclass(frozen=True)
class Demand:
    """What a diagnosis demands of an effect.

    Attributes
    ----------
    significance
        Allowed probability of a chance finding, over all effects tried together.
    least_fall
        Least relative fall of the held-out RMSE.
    """

    significance: float
    least_fall: float


@dataclass(frozen=True)
class Noise:
    """The residual of a model on some samples, as noise for an added torque.

    Attributes
    ----------
    residual
        Array [m].
    batch
        Batch of each sample, longer than the correlation of the noise.
    """

    residual: Array
    batch: NDArray[np.uint32]

    @classmethod
    def of(cls, residual: Array) -> Noise:
        """Cut `residual` into batches as the test of evidence does."""
        length = correlation_length(residual)
        return cls(residual, batches(residual.size, length, fewest=20, most=200))

    @cached_property
    def count(self) -> int:
        """Number of batches."""
        return int(self.batch.max()) + 1

    @cached_property
    def square(self) -> float:
        """Sum of squares."""
        return float(self.residual @ self.residual)

    def with_error(self, error: Array) -> Noise:
        """The noise with an `error` [m] of a model on top."""
        return replace(self, residual=self.residual + error)

    def variance_along(self, torque: Array) -> float:
        """Variance of the product of the noise with `torque` [m]."""
        scores = np.bincount(self.batch, torque * self.residual, self.count)
        count = self.count
        return float(np.sum((scores - scores.mean()) ** 2)) * count / max(count - 1, 1)


@dataclass(frozen=True)
class ExpectedNoise:
    """Noise of a planned recording.

    Attributes
    ----------
    rms
        In the unit of torque.
    memory
        Samples over which it is correlated, `correlation_length`.
    rows
        Number of samples.
    error : array [rows]
        Error of the model besides; zero if it is right.
    """

    rms: float
    memory: float
    rows: int
    error: Array | float = 0.0

    @property
    def count(self) -> int:
        """Number of batches that a test of evidence would cut."""
        return int(batches(self.rows, self.memory, fewest=20, most=200).max()) + 1

    @property
    def square(self) -> float:
        """Sum of squares."""
        return self.rows * self.rms**2 + float(np.sum(np.square(self.error)))

    def with_error(self, error: Array) -> ExpectedNoise:
        """The noise with an `error` [rows] of a model on top."""
        return replace(self, error=self.error + error)

    def variance_along(self, torque: Array) -> float:
        """Variance of the product of the noise with `torque` [rows]."""
        own = self.memory * self.rms**2 * float(torque @ torque)
        return own + float(np.sum((torque * self.error) ** 2))


def needed_factor(
    square: float,
    variance: float,
    noise: Noise | ExpectedNoise,
    count: int,
    need: Demand,
    *,
    loss: float = 0.0,
    held_out: HeldOutBalance = NOTHING_HELD_OUT,
) -> float:
    """By what a torque must be multiplied to pass with the probability `POWER`.

    Parameters
    ----------
    square
        Sum of squares of the torque, without the part that the model absorbs.
    variance
        Of the noise along it, `Noise.variance_along`.
    count
        Parameters of the effect.
    loss
        Sum of squares of the error of the wider model even where the effect is true.
    held_out
        What holding blocks out gains and costs.

    Returns
    -------
    float
        Infinite where no size is enough.
    """
    batches = noise.count
    if square <= 0 or batches <= count + 1:
        return np.inf
    spread = float(np.sqrt(variance))
    tested = np.sqrt(noncentrality(count, batches - count, need.significance)) * spread / square
    # With a factor f held-out squares fall by f^2 gained +- 2 f spread, less estimation cost.
    fall = 1.0 / (1.0 - need.least_fall) ** 2 - 1.0
    due = fall * noise.square + MARGIN * held_out.cost * variance / square + loss
    slack, gained = float(scipy.special.ndtri(POWER)) * spread, held_out.gain * square
    fell = (slack + np.sqrt(slack**2 + gained * due)) / gained
    return float(max(tested, fell))


@lru_cache(maxsize=256)
def noncentrality(count: int, freedom: int, significance: float) -> float:
    """Noncentrality at which an F test with (count, freedom) passes with probability `POWER`.

    Examples
    --------
    >>> round(noncentrality(1, 100_000, 0.05), 1)  # (1.96 + 1.645)^2
    13.0
    """
    critical = float(scipy.special.fdtri(count, freedom, 1.0 - significance))
    highest = 4.0
    while scipy.special.ncfdtr(count, freedom, highest, critical) > 1.0 - POWER:
        highest *= 2.0

    def miss(x: float) -> float:
        return float(scipy.special.ncfdtr(count, freedom, x, critical)) - (1.0 - POWER)

    return float(scipy.optimize.brentq(miss, 1e-9, highest, rtol=1e-6))
