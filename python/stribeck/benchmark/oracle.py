"""What the best possible model of a recording reaches: the generator's own formula, refitted.

Its held-out error, and how surely it detects each hidden effect.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.benchmark.draws import root_mean_square
from stribeck.benchmark.sample import Oracle
from stribeck.identify.errors.covariance import batches, correlation_length

Array = NDArray[np.float64]

#: Parameters besides its own that are the size of an effect.
SIZE_OF = {"carried": ("backlash", "elasticity")}


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


def detection(
    oracle: Oracle,
    effect: str,
    torque: Array,
    scored: NDArray[np.bool_],
    beside: Array | None = None,
) -> float:
    """Size of a hidden effect over its standard error, in the generator's own model.

    All other parameters of the model, the simpler effects that the hidden ones contain, and the
    size of each nuisance are fitted beside it: only the part of the effect's torque counts that
    they cannot replace. The standard error comes from batches longer than the correlation of the
    noise.

    Parameters
    ----------
    effect : str
        A name in ``oracle.effects``.
    torque : array [n]
        Recorded torque.
    scored : bool array [n]
        Scored samples.
    beside : array [m, k]
        Further columns, on the scored samples, that may replace the effect: those of another model.
    """
    others = [
        column
        for name, column in oracle.tangents.items()
        if name != effect and effect not in SIZE_OF.get(name, ())
    ]
    others += [*oracle.contained.values(), *oracle.nuisances]
    columns = np.column_stack(others)[scored]
    if beside is not None:
        columns = np.column_stack([columns, beside])
    columns = columns / np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-300)
    whole = oracle.effects[effect][scored]
    part = whole - columns @ linear.least_norm(columns, whole)
    if root_mean_square(part) <= 1e-9 * root_mean_square(whole):
        return 0.0
    every = np.column_stack([columns, whole / root_mean_square(whole)])
    error = (torque - oracle.prediction)[scored]
    noise = error - every @ linear.least_norm(every, error)
    batch = batches(noise.size, correlation_length(noise), fewest=20)
    scores = np.bincount(batch, part * noise)
    spread = math.sqrt(float(scores @ scores))
    return float(part @ part) / spread if spread > 0 else math.inf
