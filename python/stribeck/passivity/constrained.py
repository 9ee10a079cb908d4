"""Least squares under conditions, by damped Gauss-Newton steps.

The residual is linearised, the conditions are not. So every point after the first step holds them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.problem import Problem
from stribeck.identify.separable import Search
from stribeck.identify.triangle import Triangle
from stribeck.passivity.conditions import Conditions
from stribeck.passivity.step import step_under

Array = NDArray[np.float64]

#: Most steps, rejected ones included.
MOST_STEPS = 25
#: The search ends when the predicted relative decrease of the sum of squares is smaller.
SETTLED = 1e-7
#: Damping after a first rejected step, in squared lengths of the columns.
FIRST_DAMPING = 1e-3
#: With more damping a step is too short to change anything.
MOST_DAMPING = 1e8
#: From a point that violates a condition a step may miss its predicted sum by this factor.
ASTRAY = 1.5


def minimise_under(
    problem: Problem, values: Array, lower: Array, upper: Array, conditions: Conditions
) -> Search:
    """The least sum of squares near `values` that holds the conditions.

    The sum of squares of the result is infinite where no values were found that hold them.
    """
    free = np.flatnonzero(lower < upper)
    point = _linearised(problem, values, free)
    if point is None:
        return Search(values, np.inf, False, "the model is not finite at the start", 1)
    held, damping, evaluations = conditions.hold(values), 0.0, 1
    outcome, retreated = "stopped at the largest number of steps", False
    for _ in range(MOST_STEPS):
        refit = step_under(_damped(point, damping), values, free, lower, upper, conditions)
        if refit is None:
            return Search(values, np.inf, False, "no values hold the conditions", evaluations)
        step = (refit - values)[free]
        if held and point.fall(step) <= SETTLED * point.square:
            return Search(values, point.square, True, "converged", evaluations)
        predicted = point.square - point.fall(step)
        limit = point.square if held else ASTRAY * predicted
        tried = _linearised(problem, refit, free)
        evaluations += 1
        # Short steps do not reach the conditions: a step that holds them is accepted even if it
        # raises the sum of squares.
        if tried is not None and (tried.square <= limit or (not held and damping > 1.0)):
            values, point, held = refit, tried, True
            # Right after a rejected step the damping stays: a longer step would be rejected again.
            damping, retreated = damping if retreated else 0.1 * damping, False
            damping = damping if damping >= FIRST_DAMPING else 0.0
        else:
            damping, retreated = max(10.0 * damping, FIRST_DAMPING), True
            if damping > MOST_DAMPING:
                outcome = "converged (to rounding)"
                break
    square = point.square if held else np.inf
    return Search(values, square, outcome.startswith("converged"), outcome, evaluations)


@dataclass(frozen=True)
class Conditioned:
    """Refits within bounds [p] and under conditions."""

    lower: Array
    upper: Array
    conditions: Conditions

    def step(self, values: Array, triangle: Triangle) -> Array:
        """The values [p] after one step, unchanged where no values hold the conditions."""
        free = np.flatnonzero(self.lower < self.upper)
        refit = step_under(triangle, values, free, self.lower, self.upper, self.conditions)
        return values.copy() if refit is None else refit

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values [p] of a damped search: under conditions a single step is not reliable."""
        found = minimise_under(problem, values, self.lower, self.upper, self.conditions)
        return found.values


def _linearised(problem: Problem, values: Array, free: NDArray[np.intp]) -> Triangle | None:
    try:
        with np.errstate(all="ignore"):
            residual, jacobian = problem.linearise(values, free)
            triangle = Triangle.of(jacobian, residual)
    except _core.ModelError:
        return None
    return triangle if np.all(np.isfinite(triangle.factor)) else None


def _damped(triangle: Triangle, damping: float) -> Triangle:
    """The triangle with the rows of Levenberg and Marquardt's damping."""
    if damping == 0.0:
        return triangle
    lengths = np.sqrt(damping * np.einsum("ij,ij->j", triangle.factor, triangle.factor))
    return Triangle.of(
        np.concatenate([triangle.factor, np.diag(lengths)]),
        np.concatenate([triangle.right, np.zeros(lengths.size)]),
    )
