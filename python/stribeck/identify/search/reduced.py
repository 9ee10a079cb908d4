"""The sum of squares as a function of the nonlinear parameters alone, with its gradient.

Variable projection (Golub and Pereyra 1973): at each point the linear parameters have their best
values within bounds. There the sum does not change to first order with them, so that its gradient
by the nonlinear parameters is that at fixed linear ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reduced:
    """The least sum of squares over the linear parameters.

    Attributes
    ----------
    values : array [p]
        With the best linear parameters.
    square
        Sum of squares.
    slope : array [p]
        Its derivative by each nonlinear parameter; 0 by the others.
    """

    values: Array
    square: float
    slope: Array


def reduced(
    problem: Problem, points: Array, lower: Array, upper: Array, *, sloped: bool = True
) -> list[Reduced | None]:
    """The least sums of squares at the nonlinear parameters of `points`, array [n, p].

    None where the model is not finite. The slopes are zeros unless `sloped`.
    """
    if problem.in_core:
        made = problem.reduced(points, lower, upper, sloped)
        return [None if one is None else Reduced(*one) for one in made]
    with np.errstate(all="ignore"):
        return [_reduced(problem, values, lower, upper) for values in points]


def squares(problem: Problem, points: Array, lower: Array, upper: Array) -> Array:
    """The least sums of squares at `points` [n, p]; infinite where the model is not finite."""
    made = reduced(problem, points, lower, upper, sloped=False)
    return np.array([np.inf if one is None else one.square for one in made])


def _reduced(problem: Problem, values: Array, lower: Array, upper: Array) -> Reduced | None:
    linear = np.array([p.linear for p in problem.model.parameters], dtype=bool)
    free = lower < upper
    values = values.copy()
    own = np.flatnonzero(linear & free)
    triangle = problem.triangle(values, own, np.ones(own.size))
    if triangle is None:
        return None
    step = triangle.solve(lower[own] - values[own], upper[own] - values[own])
    values[own] = np.clip(values[own] + step, lower[own], upper[own])
    own = np.flatnonzero(~linear & free)
    triangle = problem.triangle(values, own, np.ones(own.size))
    if triangle is None:
        return None
    slope = np.zeros(values.size)
    slope[own] = -2.0 * (triangle.factor.T @ triangle.right)
    return Reduced(values, triangle.square, slope)
