"""Finish a search on all rows: Gauss-Newton with Levenberg's damping, within bounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.identify.problem import Problem

Array = NDArray[np.float64]

MOST_ROUNDS = 25
TOLERANCE = 1e-10


def polish(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    tolerance: float = TOLERANCE,
) -> tuple[Array, float, int]:
    """Bring the sum of squares down from `values`, near a minimum, to that minimum.

    Parameters
    ----------
    tolerance : float
        A relative fall of the sum of squares below this ends it.

    Returns
    -------
    values [p], sum of squares, evaluations
    """
    residual, jacobian = problem.linearise(values)
    square = float(residual @ residual)
    damping = 0.0
    evaluations = 1
    for _ in range(MOST_ROUNDS):
        matrix, vector = NormalEquations.of(jacobian, residual).total()
        damped = matrix + damping * np.diag(np.diag(matrix))
        step = solve_bounded(damped, vector, lower - values, upper - values)
        tried = np.clip(values + step, lower, upper)
        new_residual, new_jacobian = problem.linearise(tried)
        evaluations += 1
        new_square = float(new_residual @ new_residual)
        if np.isfinite(new_square) and new_square <= square:
            fall = square - new_square
            values, residual, jacobian, square = tried, new_residual, new_jacobian, new_square
            damping = 0.0 if damping < 1e-6 else damping / 10.0
            if fall <= tolerance * max(square, np.finfo(float).tiny):
                break
        else:
            damping = 1e-3 if damping == 0.0 else damping * 10.0
            if damping > 1e6:
                break
    return values, square, evaluations
