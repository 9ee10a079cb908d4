"""Subspaces of torques: orthonormal bases, and what lies outside a span."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.triangle import UNSEEN, Triangle

Array = NDArray[np.float64]


def orthonormal(columns: Array) -> Array:
    """Orthonormal basis [m, r] of the span of `columns` [m, k].

    Examples
    --------
    >>> orthonormal(np.array([[3.0, 6.0], [4.0, 8.0]])).shape
    (2, 1)
    """
    basis = columns
    # The second pass restores the accuracy lost to rounding in nearly dependent columns.
    for _ in range(2):
        size = np.sqrt(np.einsum("ij,ij->j", basis, basis))
        basis = basis[:, size > 0] / size[size > 0]
        factor = Triangle.of(basis, np.zeros(basis.shape[0])).factor
        weights, vectors = linear.singular(factor)
        kept = weights > UNSEEN * weights.max(initial=0.0)
        basis = basis @ (vectors[kept].T / weights[kept])
    return basis


def outside_span(basis: Array, torques: Array) -> Array:
    """The part of `torques` [m, k] outside the span of an orthonormal `basis` [m, r].

    Examples
    --------
    >>> outside_span(np.array([[0.6], [0.8]]), np.array([[3.0], [4.0]])).round(12)
    array([[0.],
           [0.]])
    """
    left = torques - basis @ (basis.T @ torques)
    return left - basis @ (basis.T @ left)


def sine_to_span(torque: Array, basis: Array) -> float:
    """Sine of the angle between `torque` [m] and the span of an orthonormal `basis` [m, r].

    Examples
    --------
    >>> sine_to_span(np.array([1.0, 1.0]), np.array([[1.0], [0.0]])).__round__(6)
    0.707107
    """
    length = linear.length(torque)
    if length == 0.0:
        return 0.0
    return linear.length(outside_span(basis, torque[:, None])[:, 0]) / length
