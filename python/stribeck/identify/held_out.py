"""Prediction of each held-out block by a refit without it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.separable import minimise
from stribeck.identify.triangle import Triangle, triangles

Array = NDArray[np.float64]

#: A refit ends when its next step foresees a smaller relative fall: what it would still move its
#: prediction is far below what leaving the block out does.
SETTLED = 1e-8


class Refit(Protocol):
    """How a refit goes on from known values [p]."""

    def step(self, values: Array, triangle: Triangle) -> Array:
        """Values after one Gauss-Newton step of the free parameters, from their factors there."""

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values after more steps, from a `refit` that one step from `values` has led to.

        Parameters
        ----------
        problem
            On the rows that are left.
        square : float
            Sum of squares at `values`, over these rows.
        """


@dataclass(frozen=True)
class Bounded:
    """Refits within bounds [p]; equal ones hold a parameter."""

    lower: Array
    upper: Array

    def step(self, values: Array, triangle: Triangle) -> Array:
        """One bounded step of the free parameters."""
        free = np.flatnonzero(self.lower < self.upper)
        at = values[free]
        lower, upper = self.lower[free], self.upper[free]
        refit = values.copy()
        refit[free] = np.clip(at + triangle.solve(lower - at, upper - at), lower, upper)
        return refit

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """A second step; a damped search from `values` where the first went too far."""
        free = np.flatnonzero(self.lower < self.upper)
        others = problem.triangle(refit, free, np.ones(free.size))
        if others is not None and others.square <= square:
            return self.step(refit, others)
        return minimise(problem, values, self.lower, self.upper, tolerance=SETTLED).values


def held_out_prediction(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    exact: bool = True,
    by: Refit | None = None,
) -> tuple[Array, Array]:
    """Predict each block from a refit without it.

    A refit is Gauss-Newton from the solution on all rows, with the triangular factors of the other
    blocks: exact for linear parameters, and converged in a round or two for the others, since
    leaving a tenth of the rows out moves them little. Parameters with equal bounds are held.

    Parameters
    ----------
    exact : bool
        Evaluate the model at each refit. Otherwise its linearisation serves, which is enough to
        tell candidates apart and spares running a model with a state many times; rows at rest
        then keep the prediction of the fit to all rows.
    by : Refit
        How a refit goes; default: within the bounds.

    Returns
    -------
    prediction : array [n]
        Of every row, moving or not, by the refit that has not seen the row's block.
    refits : array [blocks, p]
    """
    block = problem.recording.block
    count = problem.recording.block_count
    group = block[problem.rows].astype(np.uint32)
    prediction = problem.predict(values)
    refits = np.tile(values, (count, 1))
    if count < 2:
        return np.full_like(prediction, np.nan), refits
    by = by or Bounded(lower, upper)
    free = np.flatnonzero(lower < upper)
    if exact:
        jacobian, parts = None, problem.triangles(values, free, group, count)
    else:
        residual, jacobian = problem.linearise(values, free)
        parts = triangles(jacobian, residual, group, count)
    linear = all(p.linear for p in problem.model.parameters)
    for b in range(count):
        kept = group != b
        if kept.all():
            continue
        others = Triangle.joined([part for k, part in enumerate(parts) if k != b])
        refits[b] = by.step(values, others)
        if jacobian is not None:
            prediction[problem.rows[~kept]] += jacobian[~kept] @ (refits[b] - values)[free]
            continue
        if not linear:
            remaining = replace(problem, rows=problem.rows[kept])
            refits[b] = by.refine(remaining, refits[b], values, others.square)
        rows = np.flatnonzero(block == b)
        prediction[rows] = problem.predict(refits[b], rows)
    return prediction, refits


def held_out_residual(problem: Problem, values: Array, lower: Array, upper: Array) -> Array:
    """Residual [m] of the problem's rows, each block predicted by a linear refit without it."""
    group = problem.recording.block[problem.rows].astype(np.uint32)
    count = problem.recording.block_count
    free = np.flatnonzero(lower < upper)
    residual, jacobian = problem.linearise(values, free)
    parts = triangles(jacobian, residual, group, count)
    for b in np.unique(group):
        others = Triangle.joined([part for k, part in enumerate(parts) if k != b])
        change = (Bounded(lower, upper).step(values, others) - values)[free]
        residual[group == b] -= jacobian[group == b] @ change
    return residual
