"""Triangular factors of least-squares problems, and their bounded solution.

The factor R of a Jacobian J = QR has the condition number of J; the normal equations J'J have its
square, so half the digits are lost. The core computes the factors in a fixed order: they have the
same bits on any machine and with any number of threads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base import linear

Array = NDArray[np.float64]

#: Directions with a singular value below this share of the largest, with columns of unit length,
#: are not identifiable.
UNSEEN = 1e-10


@dataclass(frozen=True)
class Triangle:
    """The triangular form of a least-squares problem ``min |J x - r|``.

    Attributes
    ----------
    factor : array [p, p]
        R, upper triangular, with ``R'R = J'J``.
    right : array [p]
        ``Q'r``: the best step solves ``R x = right``.
    rest : float
        Norm of the part of r that no step reduces.

    Examples
    --------
    >>> columns = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]])
    >>> line = Triangle.of(columns, np.array([1.0, 3.0, 5.0]))
    >>> free = np.full(2, np.inf)
    >>> line.solve(-free, free).round(12)
    array([1., 2.])
    """

    factor: Array
    right: Array
    rest: float

    @classmethod
    def of(cls, jacobian: Array, residual: Array) -> Triangle:
        """The triangular form of J [n, p] and r [n]."""
        return triangles(jacobian, residual, np.zeros(residual.size, dtype=np.uint32), 1)[0]

    @classmethod
    def joined(cls, parts: list[Triangle]) -> Triangle:
        """The problem of all samples, from the factors of groups of samples."""
        return cls.of(
            np.concatenate([part.factor for part in parts]),
            np.concatenate([part.right for part in parts]),
        )._with_residual_of(parts)

    def _with_residual_of(self, parts: list[Triangle]) -> Triangle:
        """Include the part of the residual that no parameters can reduce, of every part."""
        rest = math.hypot(self.rest, *(part.rest for part in parts))
        return Triangle(self.factor, self.right, rest)

    @classmethod
    def of_whole(cls, whole: Array) -> Triangle:
        """The triangular form in the factor of ``[J r]``, array [p + 1, p + 1]."""
        return cls(whole[:-1, :-1], whole[:-1, -1], abs(float(whole[-1, -1])))

    def whole(self) -> Array:
        """The factor of ``[J r]``, array [p + 1, p + 1]."""
        bottom = np.append(np.zeros(self.right.size), self.rest)
        return np.vstack([np.column_stack([self.factor, self.right]), bottom])

    @property
    def square(self) -> float:
        """Sum of squares before a step."""
        return float(self.right @ self.right) + self.rest * self.rest

    def fall(self, step: Array) -> float:
        """Decrease of the sum of squares by `step` [p], without the rounding of a difference."""
        change = self.factor @ step
        return float(change @ (2.0 * self.right - change))

    def solve(self, lower: Array, upper: Array, damping: Array | None = None) -> Array:
        """The best step [p] within bounds; unidentifiable directions stay at zero.

        Parameters
        ----------
        damping : array [p]
            Levenberg's damping: ``|damping * step|^2`` is added to the objective.
        """
        root, right = self.factor, self.right
        if damping is not None and damping.any():
            root = np.concatenate([root, np.diag(damping)])
            right = np.concatenate([right, np.zeros(damping.size)])
        return least_squares(root, right, lower, upper)

    def drawn(self, rows: Array, values: Array) -> Triangle:
        """The problem with ``|rows (values + x)|^2`` in the objective: parameters drawn to zero.

        Parameters
        ----------
        rows : array [k, p]
        values : array [p]
            Parameters before the step x.
        """
        return Triangle.of(
            np.concatenate([self.factor, rows]), np.concatenate([self.right, -rows @ values])
        )._with_residual_of([self])

    def covariance(self) -> Array:
        """Pseudo-inverse of J'J [p, p], without unidentifiable directions."""
        scale = _lengths(self.factor)
        weights, vectors = linear.singular(self.factor / scale)
        shown = weights > UNSEEN * weights.max(initial=0.0)
        root = vectors[shown].T / weights[shown] / scale[:, None]
        return np.asarray(root @ root.T)


def triangles(
    jacobian: Array, residual: Array, group: NDArray[np.uint32], groups: int
) -> list[Triangle]:
    """The triangular form of each group of samples.

    Parameters
    ----------
    jacobian, residual
        J [n, p] and r [n].
    group : array [n]
        Which of the `groups` each sample belongs to.
    """
    return [Triangle.of_whole(whole) for whole in _core.triangle(jacobian, residual, group, groups)]


def least_squares(matrix: Array, right: Array, lower: Array, upper: Array) -> Array:
    """Minimise ``|A x - b|`` within bounds, from A [m, p] and b [m].

    Zeros where A is not finite.
    """
    return _core.bounded_least_squares(matrix, right, lower, upper)


def _lengths(matrix: Array) -> Array:
    """Lengths of the columns [p], 1 for one that is zero.

    Columns are divided by their largest entries first, so that squares do not overflow.
    """
    size = np.abs(matrix).max(axis=0, initial=0.0)
    size = np.where(size > 0.0, size, 1.0)
    scaled = matrix / size
    length = size * np.sqrt(np.einsum("ij,ij->j", scaled, scaled))
    return np.where(length > 0.0, length, 1.0)
