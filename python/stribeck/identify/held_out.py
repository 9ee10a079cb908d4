"""Prediction of each block of a recording by a model fitted without it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.registry import find
from stribeck.identify.problem import Problem
from stribeck.identify.search.separable import minimise
from stribeck.identify.triangle import Triangle, triangles
from stribeck.models.catalog import effect_row
from stribeck.models.model import Model

Array = NDArray[np.float64]

#: A refit ends when the predicted relative decrease is smaller: further steps would change the
#: prediction far less than leaving the block out does.
SETTLED = 1e-8


class Refit(Protocol):
    """How a refit continues from known values [p]."""

    def without(self, block: Triangle, model: Model) -> Refit:
        """The refit to the other samples than those of a block."""

    def step(self, values: Array, triangle: Triangle) -> Array:
        """Values [p] after one Gauss-Newton step, from the factors of the free parameters."""

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values [p] after more steps, from the `refit` after one step from `values`.

        Parameters
        ----------
        problem
            On the remaining samples.
        square : float
            Sum of squares at `values`, over these samples.
        """


#: The terms of a series count as determined by the other samples if these hold at least this share
#: of the information of those that are left out.
DETERMINED = 0.01
#: A second step has failed if it leaves so many times the sum of squares before the refit.
ASTRAY = 2.0


@dataclass(frozen=True)
class Bounded:
    """Refits within bounds [p]; equal bounds hold a parameter.

    Attributes
    ----------
    drawn : array [k, p] or None
        Rows of the objective that draw parameters to zero.
    """

    lower: Array
    upper: Array
    drawn: Array | None = None

    def step(self, values: Array, triangle: Triangle) -> Array:
        """One bounded step of the free parameters."""
        free = np.flatnonzero(self.lower < self.upper)
        at = values[free]
        if self.drawn is not None:
            triangle = triangle.drawn(self.drawn[:, free], at)
        lower, upper = self.lower[free], self.upper[free]
        refit = values.copy()
        refit[free] = np.clip(at + triangle.solve(lower - at, upper - at), lower, upper)
        return refit

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values after a second step, or of a damped search where a step raised the error."""
        free = np.flatnonzero(self.lower < self.upper)
        others = problem.triangle(refit, free, np.ones(free.size))
        if others is not None and others.square <= square:
            again = self.step(refit, others)
            none = np.empty(0, dtype=np.intp)
            after = problem.triangle(again, none, np.empty(0))
            if after is not None and after.square <= ASTRAY * square:
                return again
            values = refit
        return minimise(problem, values, self.lower, self.upper, tolerance=SETTLED).values

    def without(self, block: Triangle, model: Model) -> Bounded:
        """The refit to the other samples than those of a block.

        Where a range of a channel is passed in one block alone, the others say nothing about the
        terms of a series there, which would take any value: these are drawn to zero.
        """
        free = np.flatnonzero(self.lower < self.upper)
        own = np.isin(free, series(model))
        if not own.any():
            return self
        rows = np.zeros((block.right.size, self.lower.size))
        rows[:, free[own]] = np.sqrt(DETERMINED) * block.factor[:, own]
        return replace(self, drawn=rows)


def series(model: Model) -> list[int]:
    """The places of parameters that are terms of a series."""
    rows = (effect_row(effect) for effect in model.effects if (own := find(effect)) and own.series)
    names = {parameter["name"] for row in rows if row for parameter in row["parameters"]}
    return [place for place, name in enumerate(model.names) if name in names]


def held_out_prediction(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    exact: bool = True,
    by: Refit | None = None,
    predicted: Array | None = None,
) -> tuple[Array, Array]:
    """Predict each block by a model fitted without it.

    A refit takes Gauss-Newton steps from the solution on all samples, with the factors of the other
    blocks: exact for linear parameters, and converged in one or two steps for the others, which
    change little when a tenth of the samples is left out. Equal bounds hold a parameter.

    Parameters
    ----------
    exact : bool
        Evaluate the model at each refit. Otherwise its linearisation is used, which is enough to
        rank candidates; samples at rest then keep the prediction of the fit to all samples.
    by : Refit
        How a refit is done; default: within the bounds.
    predicted : array [n]
        The prediction with `values`, where it is known already.

    Returns
    -------
    The prediction of every sample by the model fitted without its block [n], and the values of each
    of these models [blocks, p].
    """
    block = problem.recording.block
    count = problem.recording.block_count
    group = block[problem.rows].astype(np.uint32)
    prediction = problem.predict(values) if predicted is None else predicted.copy()
    refits = np.tile(values, (count, 1))
    if count < 2:
        return np.full_like(prediction, np.nan), refits
    by = by or Bounded(lower, upper)
    free = np.flatnonzero(lower < upper)
    if exact:
        jacobian, parts = None, problem.triangles(values, free, group, count)
    else:
        residual, jacobian = problem.linearise(values, free)
        parts = triangles(problem.weighted(jacobian), problem.weighted(residual), group, count)
    linear = all(p.linear for p in problem.model.parameters)
    for b in np.unique(group):
        kept = group != b
        others = Triangle.joined([part for k, part in enumerate(parts) if k != b])
        own = by.without(parts[b], problem.model)
        refits[b] = own.step(values, others)
        if jacobian is not None:
            prediction[problem.rows[~kept]] += jacobian[~kept] @ (refits[b] - values)[free]
            continue
        if not linear:
            remaining = replace(problem, rows=problem.rows[kept])
            refits[b] = own.refine(remaining, refits[b], values, others.square)
        rows = np.flatnonzero(block == b)
        prediction[rows] = problem.predict(refits[b], rows)
    return prediction, refits


def held_out_residual(problem: Problem, values: Array, lower: Array, upper: Array) -> Array:
    """Residual [m] of the problem's rows, each block predicted by a linear refit without it."""
    group = problem.recording.block[problem.rows].astype(np.uint32)
    count = problem.recording.block_count
    free = np.flatnonzero(lower < upper)
    residual, jacobian = problem.linearise(values, free)
    parts = triangles(problem.weighted(jacobian), problem.weighted(residual), group, count)
    for b in np.unique(group):
        others = Triangle.joined([part for k, part in enumerate(parts) if k != b])
        refit = Bounded(lower, upper).without(parts[b], problem.model)
        change = (refit.step(values, others) - values)[free]
        residual[group == b] -= jacobian[group == b] @ change
    return residual
