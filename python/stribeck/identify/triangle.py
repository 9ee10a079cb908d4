"""Triangular factors of least-squares problems, and their bounded solution.

The factor R of a Jacobian J = QR has the condition of J; the normal equations J'J have its square
and keep half the digits. The factors are made in the core, in a fixed order, so that they have the
same bits on any machine and any number of threads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from stribeck import _core

Array = NDArray[np.float64]

#: Directions with a singular value below this share of the largest, all columns brought to length
#: one, are not shown by the data.
UNSEEN = 1e-10


@dataclass(frozen=True)
class Triangle:
    """What a least-squares problem ``min |J x - r|`` comes to.

    Attributes
    ----------
    factor : array [p, p]
        R, upper triangular, with ``R'R = J'J``.
    right : array [p]
        ``Q'r``: the best step solves ``R x = right``.
    rest : float
        Norm of the part of r that no step explains.

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
        """Factor J [n, p] and r [n]."""
        return triangles(jacobian, residual, np.zeros(residual.size, dtype=np.uint32), 1)[0]

    @classmethod
    def joined(cls, parts: list[Triangle]) -> Triangle:
        """The problem of all rows together, from the factors of groups of rows."""
        return cls.of(
            np.concatenate([part.factor for part in parts]),
            np.concatenate([part.right for part in parts]),
        )._beside(parts)

    def _beside(self, parts: list[Triangle]) -> Triangle:
        """Count in what was left over in each part already."""
        rest = np.linalg.norm([self.rest, *(part.rest for part in parts)])
        return Triangle(self.factor, self.right, float(rest))

    @property
    def square(self) -> float:
        """Sum of squares before any step."""
        return float(self.right @ self.right) + self.rest * self.rest

    def fall(self, step: Array) -> float:
        """By how much `step` [p] lowers the sum of squares: not a difference of two sums."""
        change = self.factor @ step
        return float(change @ (2.0 * self.right - change))

    def solve(self, lower: Array, upper: Array, damping: Array | None = None) -> Array:
        """The best step [p] within bounds; directions the data does not show stay at zero.

        Parameters
        ----------
        damping : array [p]
            Levenberg's: ``|damping * step|^2`` is added to what is minimised.
        """
        root, right = self.factor, self.right
        if damping is not None and damping.any():
            root = np.concatenate([root, np.diag(damping)])
            right = np.concatenate([right, np.zeros(damping.size)])
        return least_squares(root, right, lower, upper)

    def covariance(self) -> Array:
        """Inverse of J'J [p, p]; what the data does not show is left out (pseudo-inverse)."""
        scale = _lengths(self.factor)
        inverse = np.linalg.pinv(self.factor / scale, rcond=UNSEEN)
        inverse = inverse / scale[:, None]
        return np.asarray(inverse @ inverse.T)


def triangles(
    jacobian: Array, residual: Array, group: NDArray[np.uint32], groups: int
) -> list[Triangle]:
    """Factor each group of rows by itself.

    Parameters
    ----------
    jacobian, residual
        J [n, p] and r [n].
    group : array [n]
        Which of the `groups` each row belongs to.
    """
    size = _largest(jacobian)
    height = float(np.abs(residual).max(initial=0.0)) or 1.0
    made = _core.triangle(jacobian / size, residual / height, group, groups)
    return [
        Triangle(r[:-1, :-1] * size, r[:-1, -1] * height, abs(float(r[-1, -1])) * height)
        for r in made
    ]


def least_squares(matrix: Array, right: Array, lower: Array, upper: Array) -> Array:
    """Minimise ``|A x - b|`` within bounds, from A [m, p] and b [m].

    Where A has left the range of numbers there is no step: zeros.
    """
    if matrix.shape[1] == 0:
        return np.zeros(0)
    scale = _lengths(matrix)
    scaled = matrix / scale
    if not (np.all(np.isfinite(scaled)) and np.all(np.isfinite(right))):
        return np.zeros(matrix.shape[1])
    free = np.linalg.lstsq(scaled, right, rcond=UNSEEN)[0] / scale
    if np.all(free >= lower) and np.all(free <= upper):
        return np.asarray(free)
    bounded = lsq_linear(scaled, right, bounds=(lower * scale, upper * scale), method="bvls")
    return np.asarray(np.clip(bounded.x / scale, lower, upper))


def _lengths(matrix: Array) -> Array:
    """Lengths of the columns [p], 1 for one that is zero."""
    size = _largest(matrix)
    scaled = matrix / size
    length = size * np.sqrt(np.einsum("ij,ij->j", scaled, scaled))
    return np.where(length > 0.0, length, 1.0)


def _largest(matrix: Array) -> Array:
    """Largest entries of the columns [p], 1 for one that is zero.

    Divided by them, squares of very large and very small entries stay in the range of numbers.
    """
    size = np.abs(matrix).max(axis=0, initial=0.0)
    return np.where(size > 0.0, size, 1.0)
