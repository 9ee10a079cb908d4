"""How large an added torque must be for a diagnosis to see it.

The same test as in `evidence`, turned round: the size at which it answers yes with a given
probability, from the noise that the residual shows along the torque.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.diagnosis.leverage import FITTED, HeldOut
from stribeck.identify.covariance import batches, correlation_length

Array = NDArray[np.float64]

#: What estimating costs on held-out blocks may be so many times what is expected.
MARGIN = 2.0
#: Probability with which an effect of the stated size is seen.
POWER = 0.95


@dataclass(frozen=True)
class Demand:
    """What a diagnosis asks of an effect.

    Attributes
    ----------
    significance
        Probability of being chance that is allowed, over all effects tried together.
    least_fall
        Least relative fall of the held-out RMSE.
    """

    significance: float
    least_fall: float


@dataclass(frozen=True)
class Noise:
    """What is not explained on some rows, as noise for anything that is added.

    Attributes
    ----------
    residual
        Array [m].
    batch
        Number of the stretch that each row belongs to, longer than the noise's memory.
    """

    residual: Array
    batch: NDArray[np.uint32]

    @classmethod
    def of(cls, residual: Array) -> Noise:
        """Cut `residual` into stretches as the test of evidence does."""
        length = correlation_length(residual)
        return cls(residual, batches(residual.size, length, fewest=20, most=200))

    @cached_property
    def count(self) -> int:
        """Number of stretches."""
        return int(self.batch.max()) + 1

    @cached_property
    def square(self) -> float:
        """Sum of squares."""
        return float(self.residual @ self.residual)

    def beside(self, error: Array) -> Noise:
        """The noise with an `error` [m] of a model on top."""
        return replace(self, residual=self.residual + error)

    def variance_along(self, torque: Array) -> float:
        """Variance of the product of the noise with `torque` [m]."""
        scores = np.bincount(self.batch, torque * self.residual, self.count)
        count = self.count
        return float(np.sum((scores - scores.mean()) ** 2)) * count / max(count - 1, 1)


@dataclass(frozen=True)
class ExpectedNoise:
    """Noise of a recording that has not been made yet.

    Attributes
    ----------
    rms
        In the unit of torque.
    memory
        Rows over which it remembers itself, `correlation_length`.
    rows
        Number of rows.
    error : array [rows]
        What a model leaves besides; zero if it is right.
    """

    rms: float
    memory: float
    rows: int
    error: Array | float = 0.0

    @property
    def count(self) -> int:
        """Number of stretches that a test of evidence would cut."""
        return int(batches(self.rows, self.memory, fewest=20, most=200).max()) + 1

    @property
    def square(self) -> float:
        """Sum of squares."""
        return self.rows * self.rms**2 + float(np.sum(np.square(self.error)))

    def beside(self, error: Array) -> ExpectedNoise:
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
    held_out: HeldOut = FITTED,
) -> float:
    """By what a torque must be multiplied to be seen with the probability `POWER`.

    Parameters
    ----------
    square
        Sum of squares of the torque, without what the model takes up.
    variance
        Of the noise along it, `Noise.variance_along`.
    count
        Parameters of the effect.
    loss
        Sum of squares by which the effect's form misses the data even where it is the truth.
    held_out
        How the torque fares on held-out blocks.

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
    # Held-out squares fall by f^2 gained, give or take 2 f spread, less what estimating costs.
    fall = 1.0 / (1.0 - need.least_fall) ** 2 - 1.0
    due = fall * noise.square + MARGIN * held_out.cost * variance / square + loss
    slack, gained = float(scipy.special.ndtri(POWER)) * spread, held_out.gain * square
    fell = (slack + np.sqrt(slack**2 + gained * due)) / gained
    return float(max(tested, fell))


@lru_cache(maxsize=256)
def noncentrality(count: int, freedom: int, significance: float) -> float:
    """Noncentrality at which an F test with (count, freedom) answers yes with `POWER`.

    Examples
    --------
    >>> round(noncentrality(1, 100_000, 0.05), 1)  # (1.96 + 1.645)^2
    13.0
    """
    critical = float(scipy.special.fdtri(count, freedom, 1.0 - significance))
    highest = 4.0
    while scipy.special.ncfdtr(count, freedom, highest, critical) > 1.0 - POWER:
        highest *= 2.0
    miss = lambda x: float(scipy.special.ncfdtr(count, freedom, x, critical)) - (1.0 - POWER)  # noqa: E731
    return float(scipy.optimize.brentq(miss, 1e-9, highest, rtol=1e-6))
