"""What passivity asks of a model's parameters, as conditions that an optimiser can hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.model import Model
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box

Array = NDArray[np.float64]

#: What is short of its reserve by less than this share counts as held.
SLACK = 1e-9


@dataclass(frozen=True)
class Conditions:
    """Requirements at single operating points and cycles, each necessary for passivity.

    Attributes
    ----------
    model
        Whose parameters are meant; the friction alone is asked.
    requirements
        What is asked; nothing else is held.
    sizes : array [k]
        Sum of the sizes of the terms of each margin, where it was first missed. Margins are
        counted as shares of it, so that friction which vanishes with speed counts like any other.
    reserve
        The share of its size that each margin has to keep.
    """

    model: Model
    requirements: tuple[_core.Requirement, ...] = ()
    sizes: Array = field(default_factory=lambda: np.empty(0))
    reserve: float = 0.0

    def friction(self, values: Array) -> Model:
        """The friction with these values of the model's parameters."""
        return friction_part(self.model.with_values(values))[0]

    def shares(self, values: Array) -> tuple[Array, Array]:
        """Margins beyond the reserve as shares of their sizes [k], and their slopes [k, p].

        Raises
        ------
        stribeck._core.ModelError
            The friction means nothing at these values.
        """
        margins, slopes = self._margins(self.requirements, values)
        return margins / self.sizes - self.reserve, slopes / self.sizes[:, None]

    def hold(self, values: Array) -> bool:
        """Whether all of them hold."""
        if not self.requirements:
            return True
        return bool(np.all(self.shares(values)[0] >= -SLACK))

    def with_missed(self, asked: Sequence[_core.Requirement], values: Array) -> Conditions:
        """With those of what is `asked` that do not keep the reserve at these values."""
        if not asked:
            return self
        margins, slopes = self._margins(asked, values)
        sizes = np.abs(slopes * values).sum(axis=1)
        known = np.isfinite(margins) & np.isfinite(sizes) & (sizes > 0.0)
        missed = known & (margins < (self.reserve - SLACK) * sizes)
        return replace(
            self,
            requirements=(*self.requirements, *(asked[k] for k in np.flatnonzero(missed).tolist())),
            sizes=np.concatenate([self.sizes, sizes[missed]]),
        )

    def spread(self, values: Array, box: Box) -> list[_core.Requirement]:
        """What is asked at points over the box, the worst of each kind."""
        friction = self.friction(values)
        return _core.requirements(friction.core, friction.values, dict(box))

    def _margins(
        self, requirements: Sequence[_core.Requirement], values: Array
    ) -> tuple[Array, Array]:
        """Margins [k] in the unit of torque, and their slopes [k, p] by the model's parameters."""
        friction = self.friction(values)
        margins, own = _core.margins(friction.core, friction.values, list(requirements))
        slopes = np.zeros((margins.size, values.size))
        for k, name in enumerate(friction.names):
            if name in self.model.names:
                slopes[:, self.model.names.index(name)] = own[:, k]
        return margins, slopes
