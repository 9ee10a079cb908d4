"""Conditions on the parameters of a fit: passivity, and those that a user states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["Conditions", "Together"]

Array = NDArray[np.float64]


class Conditions(Protocol):
    """Functions of the parameters that must not be negative."""

    @property
    def count(self) -> int:
        """Their number n."""

    def shares(self, values: Array) -> tuple[Array, Array]:
        """The functions [n] as shares of their sizes, and their slopes [n, p].

        Raises
        ------
        stribeck._core.ModelError
            They are not defined at these values.
        """

    def hold(self, values: Array) -> bool:
        """Whether all are held, but for rounding."""


@dataclass(frozen=True)
class Together:
    """Several kinds of conditions at once; without any, all values hold them."""

    parts: tuple[Conditions, ...] = ()

    @property
    def count(self) -> int:
        """The number of all conditions."""
        return sum(part.count for part in self.parts)

    def shares(self, values: Array) -> tuple[Array, Array]:
        """Those of the parts, one after the other."""
        found = [part.shares(values) for part in self.parts if part.count]
        if not found:
            return np.empty(0), np.empty((0, values.size))
        return np.concatenate([one for one, _ in found]), np.concatenate([s for _, s in found])

    def hold(self, values: Array) -> bool:
        """Whether the conditions of all parts hold."""
        return all(part.hold(values) for part in self.parts)
