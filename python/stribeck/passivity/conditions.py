"""Passivity as conditions on a model's parameters, for a constrained optimiser."""

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

#: A condition counts as held if it falls short of its reserve by less than this share.
SLACK = 1e-9
#: Most conditions added at once: holding one mostly holds its neighbours too.
MOST_AT_ONCE = 16


@dataclass(frozen=True)
class FrictionOf:
    """The friction of a model, and which of the model's parameters belong to it.

    Attributes
    ----------
    own : int array [k]
        Index of each of the friction's parameters among the model's.
    known : bool array [k]
        Which of the friction's parameters the model has; the others are zero.
    """

    friction: Model
    own: NDArray[np.intp]
    known: NDArray[np.bool_]

    @classmethod
    def of(cls, model: Model) -> FrictionOf:
        """The friction of a model, whose values are not used."""
        friction, _ = friction_part(model)
        places = {name: k for k, name in enumerate(model.names)}
        known = np.array([name in places for name in friction.names], dtype=bool)
        own = np.array([places.get(name, 0) for name in friction.names], dtype=np.intp)
        return cls(friction, own, known)

    def values(self, values: Array) -> Array:
        """The friction's values, array [k], from the model's, array [p]."""
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
    """Requirements at single operating points and in single cycles, each necessary for passivity.

    Attributes
    ----------
    part
        The friction, to which alone the requirements apply.
    requirements
        The n requirements that are held.
    sizes : array [n]
        Sum of the absolute terms of each margin, at the values that first violated it. Margins are
        divided by it, so that friction which vanishes with speed has the same weight as any other.
    reserve
        The share of its size that each margin must keep.
    """

    part: FrictionOf
    requirements: tuple[_core.Requirement, ...] = ()
    sizes: Array = field(default_factory=lambda: np.empty(0))
    reserve: float = 0.0

    @property
    def count(self) -> int:
        """Number of requirements."""
        return len(self.requirements)

    def shares(self, values: Array) -> tuple[Array, Array]:
        """Margins beyond the reserve as shares of their sizes [n], and their slopes [n, p].

        Raises
        ------
        stribeck._core.ModelError
            The friction is not defined at these values.
        """
        margins, slopes = self.part.margins(self.requirements, values)
        return margins / self.sizes - self.reserve, slopes / self.sizes[:, None]

    def hold(self, values: Array) -> bool:
        """Whether all conditions hold."""
        if not self.requirements:
            return True
        try:
            return bool(np.all(self.shares(values)[0] >= -SLACK))
        except _core.ModelError:
            return False

    def with_missed(self, asked: Sequence[_core.Requirement], values: Array) -> Conditions:
        """Add the most violated of the requirements `asked` at these values."""
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
        """Least sizes, array [n]: the strength of a bristle is compared with all dry friction."""
        own = self.part.values(values)
        roles = np.array([p.role for p in self.part.friction.parameters])
        dry = float(np.abs(own[roles == "dry"]).sum())
        return np.array([dry if one.kind == "strength" else 0.0 for one in asked])

    def spread(self, values: Array, box: Box) -> list[_core.Requirement]:
        """Requirements at points over the box, the most violated of each kind."""
        return _core.requirements(self.part.friction.core, self.part.values(values), dict(box))
