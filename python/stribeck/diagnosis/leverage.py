"""What holding blocks out costs a wider model, and what it shows of a torque.

A refit without a block predicts it from the others. Where a block alone shows some part of an
effect (the end of a stroke that is visited once), that prediction is an extrapolation, and the
noise of the others grows in it; all follows from how much each block weighs in the fit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.tangent import orthonormal, rest

Array = NDArray[np.float64]

#: Largest weight of a block in a direction: beyond it the bounds of the parameters hold a refit
#: without the block, and its noise grows no further.
HEAVIEST = 1.0 - 1e-6


@dataclass(frozen=True)
class HeldOut:
    """How a torque beside a model fares on blocks that are held out.

    Attributes
    ----------
    gain
        Its squares that the refits of the plain model leave, over those that a fit to all leaves.
    cost
        Squared error that the wider model's refits add, in variances of the noise along it.
    """

    gain: float = 1.0
    cost: float = 0.0


#: Nothing is held out, or so little that it does not matter.
FITTED = HeldOut()


def held_out(base: Array, torque: Array, space: Array, block: NDArray[np.intp]) -> HeldOut:
    """Compare a model of span `base` with a wider one.

    Parameters
    ----------
    base : array [m, r]
        Orthonormal basis of what the plain model takes up.
    torque : array [m]
        What is looked for.
    space : array [m, k]
        What the wider model takes up besides.
    block : int array [m]
        Held-out block of each row.
    """
    left = rest(base, torque[:, None])[:, 0]
    square = float(left @ left)
    if square <= 0:
        return FITTED
    wide = np.column_stack([base, orthonormal(rest(base, space))])
    plain = base.shape[1]
    gained = cost = 0.0
    for b in np.unique(block):
        rows = block == b
        own, unseen = wide[rows], left[rows]
        gram = own.T @ own
        # The plain model's basis stands first in the wider one's.
        weight, vectors = _weights(gram[:plain, :plain])
        along = vectors.T @ (own[:, :plain].T @ unseen)
        seen = unseen + own[:, :plain] @ (vectors @ (along / (1.0 - weight)))
        gained += float(seen @ seen)
        wider, _ = _weights(gram)
        cost += float(np.sum(wider / (1.0 - wider)) - np.sum(weight / (1.0 - weight)))
    return HeldOut(max(gained / square, 1.0), max(cost, 0.0))


def _weights(gram: Array) -> tuple[Array, Array]:
    """Weight of a block in each direction of a fit [r], and the directions [r, r].

    Parameters
    ----------
    gram : array [r, r]
        Products of the basis of the fit over the rows of the block.
    """
    weights, vectors = np.linalg.eigh(gram)
    return np.clip(weights, 0.0, HEAVIEST), vectors
