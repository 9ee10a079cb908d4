"""Formulas over the parameters of a model, with their gradients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.models.model import Model

__all__ = ["ParameterFormula", "places_of", "used_names"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ParameterFormula:
    """A formula over parameters, such as ``1.2*a4``, or a condition, ``a3 >= a2``.

    Attributes
    ----------
    places : int array
        Index in the model of each parameter that it uses.

    Examples
    --------
    >>> import stribeck as sb
    >>> made = ParameterFormula.of("viscous_friction <= 2*a2", sb.model("coulomb"))
    >>> made.at(np.array([1.0, 3.0]))
    (5.0, array([-1.,  2.]))
    """

    text: str
    expression: _core.Expression
    places: NDArray[np.intp]

    @classmethod
    def of(cls, text: str, model: Model) -> ParameterFormula:
        """The formula over the names and symbols of a model's parameters.

        Raises
        ------
        SpecError
            The text is no formula, or uses a name that the model lacks; with the position.
        """
        places = places_of(model)
        expression = _parsed(text, list(places))
        used = [places[name] for name in expression.names]
        return cls(text, expression, np.array(used, dtype=np.intp))

    def at(self, values: Array) -> tuple[float, Array]:
        """The value, and its slopes [p] by the model's parameters; of a condition its slack."""
        value, own = self.expression.evaluate(values[self.places].tolist())
        slopes = np.zeros(values.size)
        np.add.at(slopes, self.places, own)
        return value, slopes


def places_of(model: Model) -> dict[str, int]:
    """Index of each parameter by name, and by symbol where only one parameter has it."""
    symbols = [p.symbol for p in model.parameters]
    by_symbol = {symbol: k for k, symbol in enumerate(symbols) if symbols.count(symbol) == 1}
    return {**by_symbol, **{name: k for k, name in enumerate(model.names)}}


def used_names(text: str, known: Mapping[str, object], *, condition: bool) -> list[str]:
    """The names that a formula uses, each a key of `known`.

    Parameters
    ----------
    condition
        Whether the text must be a condition, ``LEFT >= RIGHT``; otherwise it must be none.

    Raises
    ------
    SpecError
        It is something else.
    """
    expression = _parsed(text, list(known))
    if expression.is_condition != condition:
        right = "LEFT >= RIGHT" if condition else "a formula without a comparison"
        raise SpecError(f"{text!r}: write {right}")
    if not expression.names:
        raise SpecError(f"{text!r} has no parameter")
    return expression.names


def _parsed(text: str, known: list[str]) -> _core.Expression:
    try:
        return _core.Expression(text, known)
    except _core.ModelError as error:
        raise SpecError(f"{text!r}: {error}") from None
