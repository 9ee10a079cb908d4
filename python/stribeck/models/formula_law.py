"""Laws and effects that a user writes as a formula: ``c1*v + c2*tanh(v/c3)*abs(load)``.

The core parses the text into a program that only computes: the text is never executed as code.
Channels are v, q, a, T, tl, tm and te, or velocity, position, acceleration, temperature, load,
motor_torque and external_torque; functions are sgn, abs, exp, expm1, log, log10, sqrt, cbrt, sin,
cos, tan, atan, tanh, pow, min and max; ``pi`` is a constant; powers are written ``^`` or ``**``.
Every other name is a parameter.

The terms of the formula's sum are classified, so that effects act on them as on any law:

* dry: with the factor ``sgn(v)``; the rest of the product is the magnitude,
* dry with a smoothed sign: with the factor ``tanh`` or ``atan`` of a multiple of v; a bristle
  (effect ``presliding``) uses the amplitude without the smoothing,
* rate: zero at v = 0, such as ``c1*v`` or ``c1*abs(v)^c2*sgn(v)``,
* additive: all others.

A factor is recognised in products, not inside a sum in brackets: write a dry and a rate-dependent
part as two terms. The structure of the formula shows in which parameters the torque is linear.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from stribeck import _core
from stribeck.base.dimensions import Powers, derive, unit_text
from stribeck.base.errors import SpecError, nearest, option
from stribeck.models.catalog import effect_ids, law_ids

#: Name of a law by formula without a name of its own.
LAW = "formula"
#: Unit of a parameter that neither the formula nor the user states.
UNSTATED = "unstated"
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_RANGE = re.compile(r"(?P<lower>[^.\s].*?)?\s*\.\.\s*(?P<upper>\S.*)?")


@dataclass(frozen=True)
class Declaration:
    """What a user states about one parameter of a formula; None where nothing is stated."""

    unit: str | None = None
    lower: float = -math.inf
    upper: float = math.inf
    start: float | None = None


@dataclass(frozen=True)
class FormulaTerms:
    """Terms of friction by formula: a law, or an effect that is added to one.

    Parameters
    ----------
    name : str
        Name of the law or effect in specs, files and results.
    text : str
        The formula.
    effect : bool
        Whether it is an effect. Its parameters are then called ``NAME`` if there is only one, else
        ``NAME_PARAMETER``.
    declared : tuple of (symbol, Declaration)
        Statements about single parameters.

    Raises
    ------
    SpecError
        The text is not a formula (with the position), or a declared parameter is not in it.

    Examples
    --------
    >>> terms = FormulaTerms("creep", "c*abs(load)*sgn(v)", effect=True)
    >>> terms.names, terms.channels
    (('creep',), ('velocity', 'load_torque'))
    """

    name: str
    text: str
    effect: bool = False
    declared: tuple[tuple[str, Declaration], ...] = ()

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise SpecError(
                f"{self.name!r} cannot be the name of a law or effect: use letters, digits and _, "
                f"as in 'creep = c*abs(load)*sgn(v)'"
            )
        for symbol, stated in self.declared:
            if symbol not in self.symbols:
                raise SpecError(
                    f"the formula {self.text!r} has no parameter {symbol!r}"
                    f"{nearest(symbol, self.symbols)}; it has {', '.join(self.symbols)}"
                )
            if stated.lower > stated.upper:
                raise SpecError(
                    f"the bounds of {symbol} are empty: {stated.lower} .. {stated.upper}"
                )

    @cached_property
    def core(self) -> _core.Formula:
        """The parsed formula."""
        try:
            return _core.Formula(self.text)
        except _core.ModelError as error:
            raise SpecError(
                f"{error} of {self.text!r}" if self.text.strip() else str(error)
            ) from None

    @cached_property
    def symbols(self) -> tuple[str, ...]:
        """The parameters, as written in the formula."""
        return tuple(self.core.names)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters, as named in models."""
        if not self.effect:
            return self.symbols
        if len(self.symbols) == 1:
            return (self.name,)
        return tuple(f"{self.name}_{symbol}" for symbol in self.symbols)

    @property
    def channels(self) -> tuple[str, ...]:
        """The columns it reads."""
        return tuple(self.core.channels)

    @cached_property
    def has_dry_friction(self) -> bool:
        """Whether a term is dry friction, smoothed or not, that reads the velocity alone.

        Examples
        --------
        >>> FormulaTerms("law", "b*v + c*tanh(v/w)").has_dry_friction
        True
        >>> FormulaTerms("law", "b*v + c*abs(load)*sgn(v)").has_dry_friction
        False
        """
        made = self.core.operations
        return any(
            term["kind"] in ("dry", "smoothed")
            and {what for kind, what in made[slice(*term["part"])] if kind == "channel"}
            == {"velocity"}
            for term in self.core.terms
        )

    @cached_property
    def dimensions(self) -> tuple[Powers | None, ...]:
        """The dimension of each parameter that follows from the formula; None where none does."""
        return derive(self.core.operations, len(self.symbols))

    @cached_property
    def declarations(self) -> tuple[Declaration, ...]:
        """The declaration of each parameter."""
        stated = dict(self.declared)
        return tuple(stated.get(symbol, Declaration()) for symbol in self.symbols)

    def units(self, torque_unit: str, position_unit: str) -> tuple[str, ...]:
        """The unit of each parameter: as declared, else as it follows from the formula."""
        implied = (
            UNSTATED if powers is None else unit_text(powers, torque_unit, position_unit)
            for powers in self.dimensions
        )
        return tuple(
            unit if stated.unit is None else stated.unit
            for stated, unit in zip(self.declarations, implied, strict=True)
        )


def law_terms(text: str, parameters: Iterable[str] = ()) -> FormulaTerms:
    """The terms of a law by formula, ``"FORMULA"`` or ``"NAME = FORMULA"``.

    Parameters
    ----------
    parameters
        ``"c3: rad/s, 0.001..10, start 0.1"``: unit, bounds and start of a parameter; each part
        may be left out.
    """
    name, mark, formula = text.partition("=")
    if not mark:
        name, formula = LAW, text
    return FormulaTerms(name.strip(), formula.strip(), declared=declarations(parameters))


def effect_terms(text: str, parameters: Iterable[str] = ()) -> FormulaTerms:
    """The terms of an effect by formula, ``"NAME = FORMULA"``.

    Examples
    --------
    >>> effect_terms("creep = c*abs(load)*sgn(v)").name
    'creep'
    """
    name, mark, formula = text.partition("=")
    if not mark:
        raise SpecError(f"an effect by formula is written NAME = FORMULA, not {text!r}")
    return FormulaTerms(name.strip(), formula.strip(), True, declarations(parameters))


def effect_name(effect: str) -> str:
    """The name of an effect: its id, or the name in ``"NAME = FORMULA"``."""
    return effect.partition("=")[0].strip()


def is_formula(text: str) -> bool:
    """Whether a text is a formula, not a name: it contains an operator, a bracket or ``=``."""
    return any(mark in text for mark in "*^(=")


def declarations(texts: Iterable[str]) -> tuple[tuple[str, Declaration], ...]:
    """Parse ``"c3: rad/s, 0.001..10, start 0.1"`` texts into symbols and declarations."""
    parsed = [_declaration(text) for text in texts]
    symbols = [symbol for symbol, _ in parsed]
    for symbol in symbols:
        if symbols.count(symbol) > 1:
            raise SpecError(f"parameter {symbol} is declared twice: leave one out")
    return tuple(parsed)


def _declaration(text: str) -> tuple[str, Declaration]:
    """Parse ``"c3: rad/s, 0.001..10, start 0.1"``."""
    symbol, mark, rest = text.partition(":")
    parts = [part.strip() for part in rest.split(",")]
    if not mark or not symbol.strip() or not all(parts) or len(parts) > 3:
        raise SpecError(
            f"parameter {text!r}: write NAME: UNIT, LOW..HIGH, start VALUE (each part may be left "
            f"out)"
        )
    unit, bounds, start = None, (-math.inf, math.inf), None
    for part in parts:
        limits = _RANGE.fullmatch(part)
        if part.startswith("start "):
            start = number(part.removeprefix("start "), f"start of {symbol.strip()}")
        elif limits:
            bounds = _bounds(limits["lower"], limits["upper"], symbol.strip())
        else:
            unit = part
    return symbol.strip(), Declaration(unit, *bounds, start)


def _bounds(lower: str | None, upper: str | None, symbol: str) -> tuple[float, float]:
    low = -math.inf if lower is None else number(lower, f"lower bound of {symbol}", infinite=True)
    high = math.inf if upper is None else number(upper, f"upper bound of {symbol}", infinite=True)
    return low, high


def number(text: str, what: str, *, infinite: bool = False) -> float:
    """The number in a text of a user; `what` names it in errors."""
    try:
        value = float(text)
    except ValueError:
        raise SpecError(f"{what} is {text.strip()!r}: give a number") from None
    if math.isnan(value) or (math.isinf(value) and not infinite):
        raise SpecError(f"{what} is {text.strip()}: give a finite number")
    return value


def check_names(names: Sequence[str], spec: str) -> None:
    """Refuse a model in which two parameters have one name."""
    for name in names:
        if names.count(name) > 1:
            raise SpecError(
                f"two parameters of {spec} are called {name!r}: rename that of the formula"
            )


def check_terms(terms: FormulaTerms) -> None:
    """Refuse names that the catalog uses for laws and effects."""
    taken = (*law_ids(), *effect_ids())
    if terms.name in taken:
        raise SpecError(f"{terms.name!r} is already in the catalog: give the formula another name")
    for symbol in terms.symbols:
        if symbol in taken:
            raise SpecError(
                f"{symbol!r} in {terms.text!r} is a law or an effect of the catalog, and a formula "
                f"cannot contain one: add an effect with {option('effect', symbol)}, or rename the "
                f"parameter"
            )
