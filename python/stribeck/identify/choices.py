"""Starts, bounds and held values that a user gives for single parameters of a fit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from stribeck.base.errors import SpecError, nearest, option
from stribeck.models.formula_law import number
from stribeck.models.model import Model


@dataclass(frozen=True)
class Choices:
    """Starts, bounds and held values by parameter name or symbol, each in the parameter's unit.

    Examples
    --------
    >>> Choices.parse(start=["c3=0.1"], bound=["c2=0:"], fix=[]).bounds
    {'c2': (0.0, inf)}
    """

    start: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    fix: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def parse(cls, start: Iterable[str], bound: Iterable[str], fix: Iterable[str]) -> Choices:
        """From ``NAME=VALUE`` and ``NAME=LOW:HIGH`` texts; an end that is left out is unbounded."""
        return cls(
            {name: number(text, option("start", name)) for name, text in _pairs(start, "start")},
            {name: _range(name, text) for name, text in _pairs(bound, "bound")},
            {name: number(text, option("fix", name)) for name, text in _pairs(fix, "fix")},
        )

    def applied(self, model: Model) -> Model:
        """The model with starts as its values, and with the bounds as its limits.

        Raises
        ------
        SpecError
            A parameter that the model does not have, or that is both bounded and held, or that
            starts outside its bounds.
        """
        values = model.values.copy()
        limits = {
            **model.limits,
            **{_name(model, n): _ordered(n, b) for n, b in self.bounds.items()},
        }
        for given, value in self.fix.items():
            name = _name(model, given)
            if name in {_name(model, other) for other in (*self.bounds, *self.start)}:
                raise SpecError(f"parameter {given} is held: give it no start and no bounds")
            limits[name] = (_finite(given, value), value)
            values[model.names.index(name)] = value
        for given, value in self.start.items():
            name = _name(model, given)
            low, high = limits.get(name, (-math.inf, math.inf))
            if not low <= _finite(given, value) <= high:
                raise SpecError(
                    f"parameter {given} starts at {value:g}, outside {low:g} .. {high:g}"
                )
            values[model.names.index(name)] = value
        return replace(model, limits=limits, values=np.asarray(values))


def _pairs(texts: Iterable[str], name_of_option: str) -> list[tuple[str, str]]:
    pairs = []
    for text in texts:
        name, mark, value = text.partition("=")
        if not mark or not name.strip() or not value.strip():
            right = "NAME=LOW:HIGH" if name_of_option == "bound" else "NAME=VALUE"
            raise SpecError(
                f"{option(name_of_option, text)}: write {option(name_of_option, right)}"
            )
        pairs.append((name.strip(), value.strip()))
    return pairs


def _range(name: str, text: str) -> tuple[float, float]:
    low, mark, high = text.partition(":")
    if not mark:
        raise SpecError(
            f"{option('bound', f'{name}={text}')}: write {option('bound', 'NAME=LOW:HIGH')}"
        )
    lower = number(low, option("bound", name), infinite=True) if low.strip() else -math.inf
    upper = number(high, option("bound", name), infinite=True) if high.strip() else math.inf
    return lower, upper


def _ordered(name: str, bounds: tuple[float, float]) -> tuple[float, float]:
    low, high = bounds
    if not low <= high:
        raise SpecError(f"the bounds of {name} are empty: {low:g} .. {high:g}")
    return float(low), float(high)


def _finite(name: str, value: float) -> float:
    if not math.isfinite(value):
        raise SpecError(f"parameter {name} is {value}: give a finite number")
    return float(value)


def _name(model: Model, given: str) -> str:
    """The name of a parameter that is given by name or symbol."""
    symbols = {p.symbol: p.name for p in model.parameters}
    name = given if given in model.names else symbols.get(given)
    if name is None:
        known = tuple(dict.fromkeys((*model.names, *symbols)))
        raise SpecError(
            f"{model.spec} has no parameter {given!r}{nearest(given, known)}; it has "
            f"{', '.join(model.names)}"
        )
    return name
