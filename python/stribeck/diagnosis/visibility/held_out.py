"""What holding blocks out gains and costs where an effect is added.

A refit without a block predicts it from the others. Where one block alone shows some part of an
effect (the end of a stroke that is visited once), that prediction is an extrapolation and
amplifies the noise of the others. Both follow from the leverage of each block.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span

Array = NDArray[np.float64]

#: Largest leverage of a block in a direction: beyond it the bounds of the parameters limit a refit
#: without the block.
HEAVIEST = 1.0 - 1e-6


@dataclass(frozen=True)
class HeldOutBalance:
    """Gain and cost of an added torque on held-out blocks.

    Attributes
    ----------
    gain
        Ratio of its squares left by the refits of the plain model to those left by a fit to all.
    cost
        Squared error that the refits of the wider model add, in variances of the noise along it.
    """

    gain: float = 1.0
    cost: float = 0.0


#: No block is held out, or it makes no difference.
NOTHING_HELD_OUT = HeldOutBalance()


def held_out_balance(
    base: Array, torque: Array, space: Array, block: NDArray[np.intp]
) -> HeldOutBalance:
    """Compare a model that spans `base` with a wider one.

    Parameters
    ----------
    base : array [m, r]
        Orthonormal basis of what the plain model absorbs.
    torque : array [m]
        The added torque.
    space : array [m, k]
        What the wider model absorbs besides.
    block : int array [m]
        Held-out block of each sample.
    """
    left = outside_span(base, torque[:, None])[:, 0]
    square = float(left @ left)
    if square <= 0:
        return NOTHING_HELD_OUT
    wide = np.column_stack([base, orthonormal(outside_span(base, space))])
    plain = base.shape[1]
    gained = cost = 0.0
    for b in np.unique(block):
        rows = block == b
        own, unseen = wide[rows], left[rows]
        gram = own.T @ own
        # The basis of the plain model comes first in that of the wider model.
        weight, vectors = _weights(gram[:plain, :plain])
        along = vectors.T @ (own[:, :plain].T @ unseen)
        seen = unseen + own[:, :plain] @ (vectors @ (along / (1.0 - weight)))
        gained += float(seen @ seen)
        wider, _ = _weights(gram)
        cost += float(np.sum(wider / (1.0 - wider)) - np.sum(weight / (1.0 - weight)))
    return HeldOutBalance(max(gained / square, 1.0), max(cost, 0.0))


def _weights(gram: Array) -> tuple[Array, Array]:
    """Leverage of a block in each direction of a fit [r], and the directions [r, r].

    Parameters
    ----------
    gram : array [r, r]
        Products of the basis of the fit over the samples of the block.
    """
    weights, vectors = linear.symmetric_eigen(gram)
    return np.clip(weights, 0.0, HEAVIEST), vectors
