"""Least squares under conditions, by damped Gauss-Newton steps.

The residual is linearised, the conditions are not. So every point after the first step holds them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.constrained.objective import Objective
from stribeck.identify.constrained.region import Region
from stribeck.identify.constrained.step import step_under
from stribeck.identify.problem import Problem
from stribeck.identify.search.separable import Search
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model

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
    objective: Objective,
    values: Array,
    region: Region,
    *,
    settled: float = SETTLED,
    most: int = MOST_STEPS,
) -> Search:
    """The least cost near `values` that holds the conditions.

    The cost of the result is infinite where no values were found that hold them.

    Parameters
    ----------
    settled : float
        The search ends when the predicted relative decrease of the sum of squares is smaller.
    most : int
        Most steps, rejected ones included.
    """
    values = region.filled(values)
    point = objective.at(values, region)
    if point is None:
        return Search(values, np.inf, False, "the model is not finite at the start", 1)
    held, damping, evaluations = region.hold(values), 0.0, 1
    outcome, retreated = "stopped at the largest number of steps", False
    for _ in range(most):
        refit = step_under(_damped(point.triangle, damping), values, region)
        if refit is None:
            return Search(values, np.inf, False, "no values hold the conditions", evaluations)
        fall = point.triangle.fall((refit - values)[region.free])
        if held and fall <= settled * point.triangle.square:
            return Search(values, point.cost, True, "converged", evaluations)
        limit = point.cost if held else ASTRAY * (point.cost - fall)
        tried = objective.at(refit, region)
        evaluations += 1
        # Short steps do not reach the conditions: a step that holds them is accepted even if it
        # raises the sum of squares.
        if tried is not None and (tried.cost <= limit or (not held and damping > 1.0)):
            values, point, held = refit, tried, True
            # Right after a rejected step the damping stays: a longer step would be rejected again.
            damping, retreated = damping if retreated else 0.1 * damping, False
            damping = damping if damping >= FIRST_DAMPING else 0.0
        else:
            damping, retreated = max(10.0 * damping, FIRST_DAMPING), True
            if damping > MOST_DAMPING:
                outcome = "converged (to rounding)"
                break
    cost = point.cost if held else np.inf
    return Search(values, cost, outcome.startswith("converged"), outcome, evaluations)


@dataclass(frozen=True)
class Conditioned:
    """Refits with the priors and the loss of an objective, within a region."""

    objective: Objective
    region: Region

    def without(self, block: Triangle, model: Model) -> Conditioned:
        """The same for every block: the conditions bind its parameters."""
        return self

    def step(self, values: Array, triangle: Triangle) -> Array:
        """The values [p] after one step, unchanged where no values hold the conditions."""
        region = self.region
        if region.ties.places.size:
            varied = np.flatnonzero(region.lower < region.upper)
            factor = triangle.factor @ region.directions(values)[varied]
            tied = Triangle.of(factor, triangle.right)
            triangle = Triangle(tied.factor, tied.right, float(np.hypot(tied.rest, triangle.rest)))
        made = self.objective.with_prior(triangle, values, region)
        refit = step_under(made, values, region)
        return values.copy() if refit is None else refit

    def refine(self, problem: Problem, refit: Array, values: Array, square: float) -> Array:
        """Values [p] of a damped search: under conditions a single step is not reliable."""
        objective = replace(self.objective, problem=replace(problem, loss_weight=None))
        return minimise_under(objective, values, self.region).values


def _damped(triangle: Triangle, damping: float) -> Triangle:
    """The triangle with the rows of Levenberg and Marquardt's damping."""
    if damping == 0.0:
        return triangle
    lengths = np.sqrt(damping * np.einsum("ij,ij->j", triangle.factor, triangle.factor))
    return Triangle.of(
        np.concatenate([triangle.factor, np.diag(lengths)]),
        np.concatenate([triangle.right, np.zeros(lengths.size)]),
    )
