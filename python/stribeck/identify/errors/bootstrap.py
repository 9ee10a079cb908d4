"""Block bootstrap: refits to resamples of contiguous blocks of the recording.

The samples are divided into cells. A resample consists of blocks of four successive cells that are
drawn with replacement, over the end and on from the beginning (circular moving blocks; Politis and
Romano 1992). It is a weighting of the cells, so a refit works with the triangular factors of the
cells instead of copies of samples.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.identify.errors.covariance import batches
from stribeck.identify.held_out import Bounded
from stribeck.identify.problem import Problem
from stribeck.identify.search.separable import minimise
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model

__all__ = ["Resamples", "resampled"]

Array = NDArray[np.float64]

#: Cells of a block: blocks start at every fourth of their length.
CELLS = 4
#: Most blocks of a resample: more would not make its errors more accurate than 200 resamples do.
MOST_BLOCKS = 50
#: A refit ends when its next step changes the sum of squares by less than this share of one
#: sample's.
SETTLED = 1e-4


@dataclass(frozen=True)
class Resamples:
    """Parameters of the refits.

    Attributes
    ----------
    values : array [r, p]
    blocks : int
        Number of blocks of a resample.
    unsettled : int
        Number of refits that did not converge.
    """

    values: Array
    blocks: int
    unsettled: int

    @property
    def _correction(self) -> float:
        """Variance of b blocks over that of resamples of them, which vary around their mean."""
        return self.blocks / (self.blocks - 1.0)

    def covariance(self) -> Array:
        """Covariance of the parameters, [p, p]."""
        deviation = self.values - self.values.mean(axis=0)
        return self._correction * (deviation.T @ deviation) / (self.values.shape[0] - 1)

    def interval(self, parameter: int) -> tuple[float, float]:
        """The expanded 95 % percentile interval of a parameter.

        Quantiles at levels that allow for the number of blocks: for a mean this is the interval of
        Student's t (Hesterberg 2015).
        """
        reach = np.sqrt(self._correction) * scipy.special.stdtrit(self.blocks - 1.0, 0.975)
        level = float(scipy.special.ndtr(-reach))
        low, high = np.quantile(self.values[:, parameter], [level, 1.0 - level])
        return float(low), float(high)


def resampled(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    length: float,
    resamples: int,
    seed: int,
) -> Resamples:
    """Refit the problem to resamples of its blocks, each from the solution `values` [p].

    Parameters
    ----------
    length : float
        Correlation length of the residual in samples; blocks are at least four times as long.
    """
    blocks = int(batches(problem.rows.size, length, most=MOST_BLOCKS).max()) + 1
    count = min(CELLS * blocks, problem.rows.size)
    cell = (np.arange(problem.rows.size) * count // problem.rows.size).astype(np.uint32)
    cells = _Cells(problem, cell, count)
    linear = all(p.linear for p in problem.model.parameters)
    one_step, free = Bounded(lower, upper), np.flatnonzero(lower < upper)
    tolerance = SETTLED / problem.rows.size
    random = np.random.default_rng(seed)
    refits, unsettled = np.empty((resamples, values.size)), 0
    for refit in refits:
        starts = random.integers(count, size=-(-count // CELLS))
        drawn = (starts[:, None] + np.arange(CELLS)) % count
        weight = np.bincount(drawn.ravel(), minlength=count).astype(np.float64)
        resample = _Resample(cells, weight)
        if linear:
            refit[:] = one_step.step(values, resample.of(values, free))
            continue
        found = minimise(resample, values, lower, upper, tolerance=tolerance)
        refit[:] = found.values
        unsettled += not found.converged
    return Resamples(refits, blocks, unsettled)


@dataclass
class _Cells:
    """The triangular factors of all cells; those of the solution are kept for all resamples."""

    problem: Problem
    cell: NDArray[np.uint32]
    count: int
    _first: dict[tuple[bytes, bytes], Array] = field(default_factory=dict)

    def factors(self, values: Array, wanted: NDArray[np.intp]) -> Array:
        """Factors of ``[J r]`` of the k parameters `wanted`, [cells, k + 1, k + 1].

        The last row holds the part of the residual that no parameters reduce.
        """
        key = values.tobytes(), wanted.tobytes()
        if key in self._first:
            return self._first[key]
        parts = self.problem.triangles(values, wanted, self.cell, self.count)
        k = wanted.size
        made = np.zeros((self.count, k + 1, k + 1))
        made[:, :k, :k] = [part.factor for part in parts]
        made[:, :k, k] = [part.right for part in parts]
        made[:, k, k] = [part.rest for part in parts]
        if not self._first:
            self._first[key] = made
        return made


@dataclass(frozen=True)
class _Resample:
    """The least-squares problem with weights of the cells."""

    cells: _Cells
    weight: Array

    @property
    def model(self) -> Model:
        """The model of the fit."""
        return self.cells.problem.model

    @property
    def torque_norm(self) -> float:
        """Norm of the measured torque."""
        return self.cells.problem.torque_norm

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """The weighted problem linearised at `values`; None where the model is not finite."""
        try:
            return self.of(values, wanted, slope)
        except FitError:
            return None

    def of(self, values: Array, wanted: NDArray[np.intp], slope: Array | float = 1.0) -> Triangle:
        """The weighted problem linearised at `values`, columns times `slope`.

        Raises `FitError` where the model is not finite.
        """
        factors = self.cells.factors(values, wanted)
        drawn = np.flatnonzero(self.weight)
        weighted = np.sqrt(self.weight[drawn])[:, None, None] * factors[drawn]
        rows = weighted.reshape(-1, wanted.size + 1)
        return Triangle.of(rows[:, :-1] * slope, rows[:, -1])
