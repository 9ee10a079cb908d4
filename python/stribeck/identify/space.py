"""Where the nonlinear parameters of a model are searched between their bounds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model

Array = NDArray[np.float64]

#: The golden section.
GOLDEN = (5.0**0.5 - 1.0) / 2.0


class SearchSpace:
    """Coordinates in 0..1 of the nonlinear parameters between their bounds.

    Speeds, exponents and stiffnesses span decades: where a bound above zero allows it, the
    coordinate is that of the logarithm. A parameter whose bounds are equal is held and has none.

    Parameters
    ----------
    lower, upper : arrays [p]
        Bounds of all parameters of `model`.

    Attributes
    ----------
    nonlinear, logarithmic : bool arrays [p]
        Which parameters have a coordinate, and in the logarithm of which a search steps: in that
        of the stiffness of bristles. A step that suits a soft one is nothing to a stiff one.
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
        """Search coordinates of the nonlinear ones among `values` [..., p]."""
        low, high = self._low, self._high
        x = np.clip(values[..., self.nonlinear], low, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = np.log(x / low) / np.log(high / low)
        return np.where(self._log, logarithmic, (x - low) / (high - low))

    def decode(self, u: Array) -> Array:
        """Nonlinear parameters of search coordinates."""
        low, high = self._low, self._high
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = low * (high / low) ** u
        x = np.where(self._log, logarithmic, low + u * (high - low))
        return np.clip(x, low, high)

    def further(self, values: Array, parameters: Sequence[int]) -> Array:
        """`values` [p] with some nonlinear parameters by the golden section of their range further.

        Beyond its end it begins anew: never the same place twice, and everywhere in few steps.
        """
        which = np.isin(np.flatnonzero(self.nonlinear), parameters)
        u = self.encode(values)
        moved = values.copy()
        moved[self.nonlinear] = self.decode(np.where(which, (u + GOLDEN) % 1.0, u))
        return moved

    def drawn(self, start: Array, random: np.random.Generator) -> Array:
        """`start` [p] with nonlinear parameters at random, even over the search coordinates."""
        values = start.copy()
        values[self.nonlinear] = self.decode(random.uniform(size=int(self.nonlinear.sum())))
        return values
