"""Normal equations, summed in a fixed order, and their bounded solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base import linear

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NormalEquations:
    """Sums of J'J, J'r and r'r over groups of samples.

    Attributes
    ----------
    matrix : array [groups, p, p]
    vector : array [groups, p]
    square : array [groups]
    """

    matrix: Array
    vector: Array
    square: Array

    @classmethod
    def of(
        cls,
        jacobian: Array,
        residual: Array,
        group: NDArray[np.uint32] | None = None,
        groups: int | None = None,
    ) -> NormalEquations:
        """Sum over J [n, p] and r [n]; `group` [n] is each sample's group (default: one group)."""
        if group is None:
            group = np.zeros(residual.size, dtype=np.uint32)
        if groups is None:
            groups = int(group.max()) + 1 if group.size else 1
        return cls(*_core.normal_equations(jacobian, residual, group, groups))

    def total(self) -> tuple[Array, Array]:
        """J'J [p, p] and J'r [p] over all groups."""
        return self.matrix.sum(axis=0), self.vector.sum(axis=0)


def solve_bounded(matrix: Array, vector: Array, lower: Array, upper: Array) -> Array:
    """Minimise x'Ax/2 - b'x within bounds; unidentifiable directions stay at zero.

    Parameters
    ----------
    matrix, vector
        A [p, p] positive semidefinite and b [p].
    lower, upper
        Bounds [p]; a solution outside is moved onto them.
    """
    if vector.size == 0:
        return vector.copy()
    size = np.sqrt(np.diag(matrix))
    scale = np.where(size > 0, size, 1.0)
    weights, vectors = linear.symmetric_eigen(matrix / np.outer(scale, scale))
    seen = weights > weights[-1] * 1e-12
    root = np.sqrt(weights[seen])[:, None] * vectors[:, seen].T
    right = (vectors[:, seen].T @ (vector / scale)) / np.sqrt(weights[seen])
    solved = _core.bounded_least_squares(root, right, lower * scale, upper * scale)
    return np.clip(solved / scale, lower, upper)
