"""Singular directions of a linearised fit: what the data determines of the parameters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.triangle import UNSEEN, Triangle

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Coefficients of a combination below this share of its largest term are rounding.
NEGLIGIBLE = 1e-3
#: Lengths of columns that agree to this share are equal.
TIE = 1e-6


@dataclass(frozen=True)
class Directions:
    """Singular value decomposition of a Jacobian with columns of unit length.

    Attributes
    ----------
    index : int array [k]
        The free parameters that have an effect on the prediction.
    size : array [k]
        Lengths of their columns.
    weights, vectors : arrays [k] and [k, k]
        Singular values, the largest first, and right singular vectors, one a row.
    """

    index: NDArray[np.intp]
    size: Array
    weights: Array
    vectors: Array

    @classmethod
    def of(cls, jacobian: Array, free: Mask) -> Directions:
        """The directions of the `free` [p] columns of a Jacobian [n, p]."""
        size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
        index = np.flatnonzero(free & (size > 0.0))
        size = size[index]
        if index.size == 0:
            return cls(index, size, np.empty(0), np.empty((0, 0)))
        j = jacobian[:, index] / size
        weights, vectors = linear.singular(Triangle.of(j, np.zeros(j.shape[0])).factor)
        return cls(index, size, weights, vectors)

    def seen(self, apart: float) -> Mask:
        """Which parameters are identifiable, bool array [k].

        For these, more than the share `apart` of their column lies outside the span of the others.
        """
        if self.index.size == 0:
            return np.zeros(0, dtype=bool)
        absent = self.weights < UNSEEN * self.weights[0]
        # Parameters in a combination without effect are indistinguishable from each other.
        lost = (self.vectors[absent] ** 2).sum(axis=0) > 1e-6
        spread = np.sqrt(((self.vectors[~absent] / self.weights[~absent, None]) ** 2).sum(axis=0))
        return np.asarray(~lost & (spread * apart < 1.0))

    def hidden(self, apart: float) -> Array:
        """Directions in which the data determines nothing, array [h, k], one a row.

        Those that move the prediction by less than the share `apart`, and that are made up mainly
        of parameters that are not identifiable.
        """
        unseen = ~self.seen(apart)
        mainly = (self.vectors[:, unseen] ** 2).sum(axis=1) >= 0.5
        return self.vectors[(self.weights < apart) & mainly]

    def rank(self, apart: float) -> int:
        """Number of directions that are not hidden."""
        return self.index.size - int(self.hidden(apart).shape[0])

    def without_hidden(self, jacobian: Array, apart: float) -> Array:
        """The Jacobian [n, p] without its part in the hidden directions."""
        hidden = self.hidden(apart)
        if hidden.shape[0] == 0:
            return jacobian
        made = jacobian.copy()
        scaled = jacobian[:, self.index] / self.size
        made[:, self.index] = (scaled - (scaled @ hidden.T) @ hidden) * self.size
        return made

    def combinations(self, apart: float, parameters: int) -> Array:
        """Combinations of the parameters that are determined although these are not.

        Parameters
        ----------
        parameters
            Number p of all parameters.

        Returns
        -------
        array [d, p]
            Coefficients, one combination a row, of which the first is 1. Each row contains a
            parameter that no other row contains (reduced echelon form).

        Examples
        --------
        The second column is twice the first, the third is independent of both:

        >>> x = np.array([1.0, 2.0, 4.0])
        >>> jacobian = np.column_stack([x, 2.0 * x, x**2])
        >>> found = Directions.of(jacobian, np.ones(3, dtype=bool)).combinations(1e-4, 3)
        >>> found.round(6).tolist()
        [[1.0, 2.0, 0.0]]
        """
        unseen = np.flatnonzero(~self.seen(apart))
        hidden = self.hidden(apart)[:, unseen]
        none = np.zeros((0, parameters))
        if hidden.shape[0] == 0:
            return none
        # A combination is determined if it does not change along any hidden direction.
        basis = linear.null_space(hidden, NEGLIGIBLE).T
        count = basis.shape[0]
        if count == 0:
            return none
        # Of columns of equal length, that of the first parameter is the pivot.
        first = 1.0 - TIE * np.arange(basis.shape[1])
        order = linear.pivots(basis * first)
        reduced = linear.solve(basis[:, order[:count]], basis)
        reduced[np.abs(reduced) < NEGLIGIBLE] = 0.0
        reduced = reduced[np.count_nonzero(reduced, axis=1) > 1]
        leading = np.argmax(reduced != 0.0, axis=1)
        made = np.zeros((leading.size, parameters))
        made[:, self.index[unseen]] = reduced * self.size[unseen]
        made /= made[np.arange(leading.size), self.index[unseen][leading]][:, None]
        return np.asarray(made[np.argsort(leading, kind="stable")])
