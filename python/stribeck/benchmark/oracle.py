"""The held-out error of the generator's formula with parameters fitted to the recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.benchmark.draws import root_mean_square
from stribeck.benchmark.sample import Oracle

Array = NDArray[np.float64]


def held_out_rmse(
    oracle: Oracle, torque: Array, scored: NDArray[np.bool_], block: NDArray[np.integer]
) -> float:
    """RMSE over the scored samples, each block predicted by parameters fitted without it.

    Parameters
    ----------
    torque : array [n]
        Recorded torque.
    scored : bool array [n]
        Scored samples.
    block : int array [n]
        Held-out block of each row: the same blocks as the diagnosis uses.
    """
    columns = np.column_stack(list(oracle.tangents.values()))[scored]
    columns = columns / np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-300)
    error = (torque - oracle.prediction)[scored]
    group = block[scored]
    left = np.empty_like(error)
    for b in np.unique(group):
        inside = group == b
        others = ~inside if not inside.all() else inside
        change = linear.least_norm(columns[others], error[others])
        left[inside] = error[inside] - columns[inside] @ change
    return root_mean_square(left)
