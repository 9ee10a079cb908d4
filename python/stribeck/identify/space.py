"""Coordinates in which the nonlinear parameters of a model are searched between bounds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model

Array = NDArray[np.float64]

#: The golden ratio minus one.
GOLDEN = (5.0**0.5 - 1.0) / 2.0


class SearchSpace:
    """Coordinates in 0..1 of the nonlinear parameters between their bounds.

    Speeds, exponents and stiffnesses span decades: where the lower bound is above zero, the
    coordinate is linear in the logarithm. A parameter with equal bounds is held and has none.

    Parameters
    ----------
    lower, upper : arrays [p]
        Bounds of all parameters of `model`.

    Attributes
    ----------
    nonlinear, logarithmic : bool arrays [p]
        Which parameters have a coordinate, and which are searched in steps of their logarithm: the
        stiffness of bristles, since a step that suits a soft bristle hardly changes a stiff one.
    """

    def __init__(self, model: Model, lower: Array, upper: Array) -> None:
        linear = np.array([p.linear for p in model.parameters], dtype=bool)
        self.lower, self.upper = lower, upper
        self.nonlinear = ~linear & (lower < upper)
        stiffness = np.array([p.scale == "stiffness" for p in model.parameters], dtype=bool)
        self.logarithmic = self.nonlinear & stiffness & (lower > 0.0)
        self._low, self._high = lower[self.nonlinear], upper[self.nonlinear]
        self._log = self._low > 0

    def encode(self, values: Array) -> Array:
        """Search coordinates [..., k] of the k nonlinear parameters among `values` [..., p]."""
        low, high = self._low, self._high
        x = np.clip(values[..., self.nonlinear], low, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = np.log(x / low) / np.log(high / low)
        return np.where(self._log, logarithmic, (x - low) / (high - low))

    def decode(self, u: Array) -> Array:
        """Nonlinear parameters [..., k] at search coordinates `u`, array [..., k]."""
        low, high = self._low, self._high
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = low * (high / low) ** u
        x = np.where(self._log, logarithmic, low + u * (high - low))
        return np.clip(x, low, high)

    def further(self, values: Array, parameters: Sequence[int]) -> Array:
        """Move some nonlinear parameters of `values` [p] by the golden section of their range.

        A parameter that passes the end of its range continues at the other end. So repeated moves
        cover the range evenly and never meet the same place twice.
        """
        which = np.isin(np.flatnonzero(self.nonlinear), parameters)
        u = self.encode(values)
        moved = values.copy()
        moved[self.nonlinear] = self.decode(np.where(which, (u + GOLDEN) % 1.0, u))
        return moved

    def drawn(self, start: Array, random: np.random.Generator) -> Array:
        """`start` [p] with random nonlinear parameters, uniform in the search coordinates."""
        values = start.copy()
        values[self.nonlinear] = self.decode(random.uniform(size=int(self.nonlinear.sum())))
        return values
