"""The values that a fit may take: bounds, ties and conditions."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.constrained.conditions import Conditions, Together
from stribeck.identify.constrained.constraints import SLACK, Ties

__all__ = ["Region"]

Array = NDArray[np.float64]
NO_TIES = Ties(np.empty(0, dtype=np.intp), ())


@dataclass(frozen=True)
class Region:
    """Bounds [p], ties and conditions of a model's p parameters.

    The k free parameters are those that are neither held (equal bounds) nor tied. Bounds of a tied
    parameter are conditions.
    """

    lower: Array
    upper: Array
    conditions: Conditions = field(default_factory=Together)
    ties: Ties = NO_TIES

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Indices of the free parameters, int array [k]."""
        tied = np.zeros(self.lower.size, dtype=bool)
        tied[self.ties.places] = True
        return np.flatnonzero((self.lower < self.upper) & ~tied)

    @cached_property
    def wanted(self) -> NDArray[np.intp]:
        """Indices of the parameters whose values change, int array."""
        return np.union1d(self.free, self.ties.places)

    def filled(self, values: Array) -> Array:
        """The values [p] between the bounds, with the tied parameters computed."""
        return self.ties.filled(np.clip(values, self.lower, self.upper))

    def directions(self, values: Array) -> Array:
        """Derivatives [p, k] of all parameters by the free ones."""
        return self.ties.directions(values)[:, self.free]

    @property
    def count(self) -> int:
        """Number of conditions, with those of tied parameters."""
        return self.conditions.count + self._sides[0].size

    def shares(self, values: Array) -> tuple[Array, Array]:
        """The conditions [n] as shares of their sizes, and their slopes [n, k] by the free ones.

        Raises
        ------
        stribeck._core.ModelError
            A condition is not defined at these values.
        """
        shares, slopes = self.conditions.shares(values)
        place, sign, limit, size = self._sides
        shares = np.concatenate([shares, sign * (values[place] - limit) / size])
        own = np.zeros((place.size, values.size))
        own[np.arange(place.size), place] = sign / size
        return shares, np.concatenate([slopes, own]) @ self.directions(values)

    def hold(self, values: Array) -> bool:
        """Whether all conditions hold."""
        place, sign, limit, size = self._sides
        if np.any(sign * (values[place] - limit) < -SLACK * size):
            return False
        return self.conditions.hold(values)

    def finite_shares(self, values: Array) -> tuple[Array, Array]:
        """`shares`, where undefined conditions count as violated."""
        try:
            with np.errstate(all="ignore"):
                return self.shares(values)
        except _core.ModelError:
            return np.full(self.count, -1.0), np.zeros((self.count, self.free.size))

    @cached_property
    def _sides(self) -> tuple[NDArray[np.intp], Array, Array, Array]:
        """Finite bounds of tied parameters: parameter, sign, limit and size of each."""
        place, sign, limit = [], [], []
        for tied in self.ties.places.tolist():
            for side, bound in ((1.0, self.lower[tied]), (-1.0, self.upper[tied])):
                if np.isfinite(bound):
                    place.append(tied)
                    sign.append(side)
                    limit.append(float(bound))
        index = np.array(place, dtype=np.intp)
        room = self.upper[index] - self.lower[index]
        size = np.where(np.isfinite(room), room, np.maximum(np.abs(limit), 1.0))
        return index, np.array(sign), np.array(limit), size
