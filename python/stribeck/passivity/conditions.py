"""What passivity asks of a model's parameters, as conditions that an optimiser can hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.models.model import Model
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box

Array = NDArray[np.float64]

#: What is short of its reserve by less than this share counts as held.
SLACK = 1e-9
#: Most that are added at once: neighbours of one that is missed are mostly met together with it.
MOST_AT_ONCE = 16


@dataclass(frozen=True)
class FrictionOf:
    """The friction of a model, and which of the model's parameters are its own.

    Attributes
    ----------
    own : int array [k]
        Where the friction's parameters stand among the model's.
    known : bool array [k]
        Those that the model has; the others are zero.
    """

    friction: Model
    own: NDArray[np.intp]
    known: NDArray[np.bool_]

    @classmethod
    def of(cls, model: Model) -> FrictionOf:
        """Of a model whatever its values."""
        friction, _ = friction_part(model)
        places = {name: k for k, name in enumerate(model.names)}
        known = np.array([name in places for name in friction.names], dtype=bool)
        own = np.array([places.get(name, 0) for name in friction.names], dtype=np.intp)
        return cls(friction, own, known)

    def values(self, values: Array) -> Array:
        """The friction's values [k] among the model's [p]."""
        return np.where(self.known, values[self.own], 0.0)

    def margins(
        self, requirements: Sequence[_core.Requirement], values: Array
    ) -> tuple[Array, Array]:
        """Margins [n] in the unit of torque, and their slopes [n, p] by the model's parameters."""
        core = self.friction.core
        margins, own = _core.margins(core, self.values(values), list(requirements))
        slopes = np.zeros((margins.size, values.size))
        slopes[:, self.own[self.known]] = own[:, self.known]
        return margins, slopes


@dataclass(frozen=True)
class Conditions:
    """Requirements at single operating points and cycles, each necessary for passivity.

    Attributes
    ----------
    part
        The friction, which alone is asked.
    requirements
        What is asked; nothing else is held.
    sizes : array [n]
        Sum of the sizes of the terms of each margin, where it was first missed. Margins are
        counted as shares of it, so that friction which vanishes with speed counts like any other.
    reserve
        The share of its size that each margin has to keep.
    """

    part: FrictionOf
    requirements: tuple[_core.Requirement, ...] = ()
    sizes: Array = field(default_factory=lambda: np.empty(0))
    reserve: float = 0.0

    def shares(self, values: Array) -> tuple[Array, Array]:
        """Margins beyond the reserve as shares of their sizes [n], and their slopes [n, p].

        Raises
        ------
        stribeck._core.ModelError
            The friction means nothing at these values.
        """
        margins, slopes = self.part.margins(self.requirements, values)
        return margins / self.sizes - self.reserve, slopes / self.sizes[:, None]

    def hold(self, values: Array) -> bool:
        """Whether all of them hold."""
        if not self.requirements:
            return True
        try:
            return bool(np.all(self.shares(values)[0] >= -SLACK))
        except _core.ModelError:
            return False

    def with_missed(self, asked: Sequence[_core.Requirement], values: Array) -> Conditions:
        """With what is `asked` and does not keep the reserve at these values, the worst of it."""
        if not asked:
            return self
        margins, slopes = self.part.margins(asked, values)
        sizes = np.maximum(np.abs(slopes * values).sum(axis=1), self._least_sizes(asked, values))
        known = np.isfinite(margins) & np.isfinite(sizes) & (sizes > 0.0)
        missed = np.flatnonzero(known & (margins < (self.reserve - SLACK) * sizes))
        missed = missed[np.argsort(margins[missed] / sizes[missed], kind="stable")][:MOST_AT_ONCE]
        return replace(
            self,
            requirements=(*self.requirements, *(asked[k] for k in missed.tolist())),
            sizes=np.concatenate([self.sizes, sizes[missed]]),
        )

    def _least_sizes(self, asked: Sequence[_core.Requirement], values: Array) -> Array:
        """Least sizes [n]: a bristle's strength counts beside all dry friction, however weak."""
        own = self.part.values(values)
        roles = np.array([p.role for p in self.part.friction.parameters])
        dry = float(np.abs(own[roles == "dry"]).sum())
        return np.array([dry if one.kind == "strength" else 0.0 for one in asked])

    def spread(self, values: Array, box: Box) -> list[_core.Requirement]:
        """What is asked at points over the box, the worst of each kind."""
        return _core.requirements(self.part.friction.core, self.part.values(values), dict(box))
