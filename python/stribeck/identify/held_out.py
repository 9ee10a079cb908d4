"""Prediction of each held-out block by a refit without it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.identify.problem import Problem

Array = NDArray[np.float64]


def held_out_prediction(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    exact: bool = True,
    rounds: int = 2,
) -> tuple[Array, Array]:
    """Predict each block from a refit without it.

    A refit is Gauss-Newton from the solution on all rows: the blocks' normal equations are
    subtracted, which is exact for linear parameters and converges in a round or two for the
    others, since leaving a tenth of the rows out moves them little.

    Parameters
    ----------
    exact : bool
        Evaluate the model at each refit. Otherwise its linearisation serves, which is enough to
        tell candidates apart and spares running a model with a state many times; rows at rest
        then keep the prediction of the fit to all rows.

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
    residual, jacobian = problem.linearise(values)
    sums = NormalEquations.of(jacobian, residual, group)
    linear = all(p.linear for p in problem.model.parameters)
    for b in range(count):
        if b >= sums.square.size:
            continue
        matrix = sums.matrix.sum(axis=0) - sums.matrix[b]
        vector = sums.vector.sum(axis=0) - sums.vector[b]
        refits[b] = _step(values, matrix, vector, lower, upper)
        if not exact:
            here = group == b
            prediction[problem.rows[here]] += jacobian[here] @ (refits[b] - values)
            continue
        if not linear:
            for _ in range(rounds - 1):
                kept = group != b
                r, j = problem.linearise(refits[b])
                matrix, vector = NormalEquations.of(
                    np.ascontiguousarray(j[kept]), np.ascontiguousarray(r[kept])
                ).total()
                refits[b] = _step(refits[b], matrix, vector, lower, upper)
        rows = block == b
        prediction[rows] = problem.predict(refits[b])[rows]
    return prediction, refits


def _step(values: Array, matrix: Array, vector: Array, lower: Array, upper: Array) -> Array:
    """One bounded Gauss-Newton step."""
    step = solve_bounded(matrix, vector, lower - values, upper - values)
    return np.clip(values + step, lower, upper)
