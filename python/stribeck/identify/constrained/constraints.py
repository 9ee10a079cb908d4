"""Constraints and ties between the parameters of a fit, as a user states them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.identify.stated.expressions import ParameterFormula, places_of
from stribeck.models.model import Model

__all__ = ["ParameterConstraints", "Ties"]

Array = NDArray[np.float64]

#: A constraint is held if it falls short by less than this share of its size.
SLACK = 1e-9


@dataclass(frozen=True)
class ParameterConstraints:
    """Inequalities between formulas of parameters, ``static_friction >= coulomb_friction``.

    Attributes
    ----------
    formulas
        Each with its slack, the larger side minus the smaller one, as value.
    sizes : array [n]
        The slacks are divided by it: the sum of what each parameter contributes at the start.
    """

    formulas: tuple[ParameterFormula, ...]
    sizes: Array

    @classmethod
    def of(cls, model: Model, values: Array) -> ParameterConstraints:
        """The constraints of a model whose parameters it has, scaled at some values [p]."""
        known = places_of(model)
        formulas = tuple(
            ParameterFormula.of(text, model)
            for text, names in model.stated.constraints
            if all(name in known for name in names)
        )
        sizes = []
        for formula in formulas:
            _, slopes = formula.at(values)
            size = float(np.abs(slopes * values).sum())
            sizes.append(size if np.isfinite(size) and size > 0.0 else 1.0)
        return cls(formulas, np.array(sizes))

    @property
    def count(self) -> int:
        """Number of constraints."""
        return len(self.formulas)

    def slacks(self, values: Array) -> Array:
        """The slacks [n], in their own units."""
        return np.array([formula.at(values)[0] for formula in self.formulas])

    def shares(self, values: Array) -> tuple[Array, Array]:
        """The slacks as shares of their sizes [n], and their slopes [n, p]."""
        found = [formula.at(values) for formula in self.formulas]
        slacks = np.array([slack for slack, _ in found])
        slopes = np.array([own for _, own in found]).reshape(len(found), values.size)
        return slacks / self.sizes, slopes / self.sizes[:, None]

    def hold(self, values: Array) -> bool:
        """Whether all are held."""
        return bool(np.all(self.shares(values)[0] >= -SLACK))


@dataclass(frozen=True)
class Ties:
    """Parameters that are formulas of others, ``a5 = 1.2*a4``.

    Attributes
    ----------
    places : int array [t]
        Index of each tied parameter in the model.
    formulas
        What each is equal to.
    """

    places: NDArray[np.intp]
    formulas: tuple[ParameterFormula, ...]

    @classmethod
    def of(cls, model: Model) -> Ties:
        """The ties of a model whose parameters it has.

        Raises
        ------
        SpecError
            A tied parameter is held, or depends on a tied one.
        """
        known = places_of(model)
        own = {
            known[name]: (name, ParameterFormula.of(text, model))
            for name, (text, names) in model.stated.ties.items()
            if name in known and all(other in known for other in names)
        }
        for name, formula in own.values():
            if model.limits.get(name, (0.0, 1.0))[0] == model.limits.get(name, (0.0, 1.0))[1]:
                raise SpecError(f"parameter {name} is both held and tied: omit one")
            for place in formula.places:
                if int(place) in own:
                    raise SpecError(
                        f"{name} = {formula.text} depends on {model.names[place]}, which is tied "
                        f"too: write it with the parameters that {model.names[place]} depends on"
                    )
        return cls(
            np.array(list(own), dtype=np.intp), tuple(formula for _, formula in own.values())
        )

    def filled(self, values: Array) -> Array:
        """The values [p] with the tied parameters computed."""
        made = values.copy()
        for place, formula in zip(self.places, self.formulas, strict=True):
            made[place] = formula.at(values)[0]
        return made

    def directions(self, values: Array) -> Array:
        """Derivatives [p, p] of all parameters by the parameters; 0 by a tied one."""
        made = np.eye(values.size)
        for place, formula in zip(self.places, self.formulas, strict=True):
            made[place] = formula.at(values)[1]
        return made
