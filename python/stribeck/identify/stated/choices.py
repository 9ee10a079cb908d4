"""What a user states about the parameters of a fit."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from numbers import Real
from typing import TypeAlias, TypedDict, TypeVar

import numpy as np

from stribeck.base.arguments import RULES
from stribeck.base.errors import SpecError, nearest, one_line, option
from stribeck.identify.search.algorithms import check_algorithm
from stribeck.identify.stated.statements import (
    checked_loss,
    checked_prior,
    names_in,
    read_prior,
    stated_constraint,
    stated_tie,
)
from stribeck.models.catalog import effect_ids, effect_row
from stribeck.models.formula_law import effect_terms, is_formula, number
from stribeck.models.model import Model
from stribeck.models.stated import Stated

__all__ = [
    "CHOICE_NAMES",
    "ChoiceArguments",
    "Choices",
    "parameters_of_effects",
    "refuse_statements",
]

Value = TypeVar("Value")
#: One ``NAME=VALUE`` text, or several.
Texts: TypeAlias = str | Sequence[str]


class ChoiceArguments(TypedDict, total=False):
    """Keyword arguments about parameters, by name or symbol, in the parameters' units.

    ``start={"c3": 0.1}``, ``bounds={"c2": (0.0, 5.0)}`` (infinite: unbounded), ``fix={"c1": 0.3}``,
    ``prior={"inertia": (0.12, 0.01)}`` (mean and standard deviation),
    ``constraints=["static_friction >= a2"]``, ``ties={"a5": "1.2*a4"}``, ``loss="huber"``
    (``"squares"``, ``"huber"``, ``"cauchy"``) and ``algorithm="slsqp"`` (the search from each
    start: ``"gauss-newton"``, or an algorithm of nlopt). The first six may be texts as on the
    command line: ``bounds="c2=0:5"``. All stay in force when effects are added. They may name
    parameters of effects that are added later.
    """

    start: Mapping[str, float] | Texts | None
    bounds: Mapping[str, tuple[float, float]] | Texts | None
    fix: Mapping[str, float] | Texts | None
    prior: Mapping[str, tuple[float, float]] | Texts | None
    constraints: Texts | None
    ties: Mapping[str, str] | Texts | None
    loss: str | None
    algorithm: str | None


#: The names of these arguments.
CHOICE_NAMES = tuple(ChoiceArguments.__annotations__)


@dataclass(frozen=True)
class Choices:
    """What is stated about parameters, by name or symbol, each in the parameter's unit.

    `ChoiceArguments` explains each kind.

    Examples
    --------
    >>> Choices.of({"start": ["c3=0.1"], "bounds": "c2=0:"}).bounds
    {'c2': (0.0, inf)}
    """

    start: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    fix: Mapping[str, float] = field(default_factory=dict)
    prior: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    constraints: tuple[str, ...] = ()
    ties: Mapping[str, str] = field(default_factory=dict)
    loss: str | None = None
    algorithm: str | None = None

    @classmethod
    def of(cls, arguments: ChoiceArguments) -> Choices:
        """From keyword arguments: mappings, or ``NAME=VALUE`` texts as on the command line.

        An end of bounds that is left out is unbounded.

        Raises
        ------
        SpecError
            An argument of another name, or one in another form.
        """
        for name in arguments:
            if name not in CHOICE_NAMES:
                hint = nearest(name, (*CHOICE_NAMES, *RULES))
                raise SpecError(f"there is no argument `{name}`{hint}")
        constraints, loss = arguments.get("constraints") or (), arguments.get("loss")
        algorithm = arguments.get("algorithm")
        if not isinstance(constraints, Iterable) or not all(
            isinstance(t, str) for t in constraints
        ):
            raise SpecError(f"{option('constraints')} is no text: give 'LEFT >= RIGHT', or a list")
        return cls(
            _given(arguments.get("start"), "start", "NAME=VALUE", number),
            _given(arguments.get("bounds"), "bounds", "NAME=LOW:HIGH", _range),
            _given(arguments.get("fix"), "fix", "NAME=VALUE", number),
            _given(arguments.get("prior"), "prior", "NAME=MEAN+-SD", read_prior),
            (constraints,) if isinstance(constraints, str) else tuple(constraints),
            _given(arguments.get("ties"), "ties", "NAME=FORMULA", lambda text, _: text),
            None if loss is None else checked_loss(loss),
            None if algorithm is None else check_algorithm(algorithm),
        )

    def arguments(self) -> ChoiceArguments:
        """The keyword arguments that state the same."""
        return {
            "start": self.start,
            "bounds": self.bounds,
            "fix": self.fix,
            "prior": self.prior,
            "constraints": self.constraints,
            "ties": self.ties,
            "loss": self.loss,
            "algorithm": self.algorithm,
        }

    @property
    def is_empty(self) -> bool:
        """Whether nothing is stated."""
        return not self.names and self.loss is None and self.algorithm is None

    @property
    def names(self) -> tuple[str, ...]:
        """The names and symbols that are given, each once."""
        texts = (*self.constraints, *self.ties.values())
        given = (*self.start, *self.bounds, *self.fix, *self.prior, *self.ties)
        return tuple(dict.fromkeys((*given, *(name for text in texts for name in names_in(text)))))

    def about(self, model: Model) -> Choices:
        """The choices about parameters that `model` has."""
        known = _places(model.names, _symbols(model))

        def own(given: Mapping[str, Value]) -> dict[str, Value]:
            return {name: value for name, value in given.items() if name in known}

        def is_own(text: str) -> bool:
            return all(name in known for name in names_in(text))

        return Choices(
            own(self.start),
            own(self.bounds),
            own(self.fix),
            own(self.prior),
            tuple(text for text in self.constraints if is_own(text)),
            {name: text for name, text in own(self.ties).items() if is_own(text)},
            self.loss,
            self.algorithm,
        )

    def applied_to_each(self, models: Sequence[Model]) -> list[Model]:
        """The models, each with the choices about its parameters.

        Raises
        ------
        SpecError
            As of `applied`, or a parameter is in none of the models.
        """
        known = {place for model in models for place in (*model.names, *_symbols(model))}
        for name in self.names:
            if name not in known:
                specs = ", ".join(dict.fromkeys(model.spec for model in models)) or "no model"
                raise SpecError(
                    f"no model that is fitted has a parameter {name!r}{nearest(name, known)}; "
                    f"fitted: {specs}"
                )
        return [self.about(model).applied(model) for model in models]

    def applied(self, model: Model, later: Mapping[str, str] | None = None) -> Model:
        """The model with starts as its values, and with the bounds as its limits.

        Parameters
        ----------
        later
            Names of parameters that effects may bring later, by name and symbol
            (`parameters_of_effects`).

        Raises
        ------
        SpecError
            A parameter that the model does not have, or that is both bounded and held, or that
            starts outside its bounds; a text that is no formula.
        """
        start = _named(model, self.start, "start", later or {})
        bounds = _named(model, self.bounds, "bounds", later or {})
        fix = _named(model, self.fix, "fix", later or {})
        limits = {**model.limits, **{name: _ordered(name, b) for name, b in bounds.items()}}
        values = dict(zip(model.names, model.values, strict=True))
        starts = {**model.stated.starts, **start}
        for name, value in fix.items():
            if name in start or name in bounds:
                raise SpecError(f"parameter {name} is held: give it no start and no bounds")
            limits[name] = (_finite(name, value), float(value))
            starts[name] = float(value)
        for name, value in start.items():
            low, high = limits.get(name, (-math.inf, math.inf))
            if not low <= _finite(name, value) <= high:
                raise SpecError(
                    f"parameter {name} starts at {value:g}, outside {low:g} .. {high:g}"
                )
        given = {name: value for name, value in {**start, **fix}.items() if name in values}
        return replace(
            model,
            limits=limits,
            stated=self._stated(model, later or {}, starts),
            values=np.array([given.get(name, value) for name, value in values.items()]),
        )

    def _stated(self, model: Model, later: Mapping[str, str], starts: dict[str, float]) -> Stated:
        """The statements of the model with these beside them."""
        stated = model.stated
        known = {**later, **_places(model.names, _symbols(model))}
        prior = _named(model, self.prior, "prior", later)
        ties = _named(model, self.ties, "ties", later)
        for name in ties:
            if name in self.fix or name in starts or name in prior:
                raise SpecError(f"parameter {name} is tied: give it no start, value or prior")
        return Stated(
            starts,
            {**stated.priors, **{name: checked_prior(name, own) for name, own in prior.items()}},
            (*stated.constraints, *(stated_constraint(text, known) for text in self.constraints)),
            {**stated.ties, **{name: stated_tie(name, text, known) for name, text in ties.items()}},
            stated.loss if self.loss is None else self.loss,
            stated.algorithm if self.algorithm is None else self.algorithm,
        )


def refuse_statements(model: Model, what: str) -> None:
    """Raise `SpecError` if `model` has statements other than bounds, which `what` ignores."""
    if model.stated.changes_the_search:
        given = [option(n) for n in ("prior", "constraints", "ties", "loss")]
        raise SpecError(f"{what} does not take {', '.join(given[:-1])} and {given[-1]}: omit them")


def parameters_of_effects(
    effects: Iterable[str] | None = None, candidates: Iterable[str] = ()
) -> dict[str, str]:
    """The names of the parameters that effects bring, by name, and by symbol where it is unique.

    Parameters
    ----------
    effects
        Ids, or ``"NAME = FORMULA"``; default: all of the catalog.
    candidates
        Further effects by formula.
    """
    rows: list[tuple[str, str]] = []
    for effect in (*(effect_ids() if effects is None else effects), *candidates):
        row = effect_row(effect)
        if row is not None:
            rows += [(p["name"], p["symbol"]) for p in row["parameters"]]
        elif is_formula(effect):
            terms = effect_terms(effect)
            rows += zip(terms.names, terms.symbols, strict=True)
    return _places([name for name, _ in rows], [symbol for _, symbol in rows])


def _places(names: Sequence[str], symbols: Sequence[str]) -> dict[str, str]:
    """Names by name, and by symbol where only one parameter has it."""
    of_symbol: dict[str, set[str]] = {}
    for name, symbol in zip(names, symbols, strict=True):
        of_symbol.setdefault(symbol, set()).add(name)
    unique = {symbol: min(own) for symbol, own in of_symbol.items() if len(own) == 1}
    return {**unique, **{name: name for name in names}}


def _symbols(model: Model) -> list[str]:
    return [p.symbol for p in model.parameters]


def _named(
    model: Model, given: Mapping[str, Value], name_of_option: str, later: Mapping[str, str]
) -> dict[str, Value]:
    """What is given by name or symbol, by name."""
    own = _places(model.names, _symbols(model))
    made: dict[str, Value] = {}
    for said, value in given.items():
        name = own.get(said, later.get(said))
        if name is None:
            known = tuple(dict.fromkeys((*own, *later)))
            raise SpecError(
                f"{model.spec} has no parameter {said!r}{nearest(said, known)}; it has "
                f"{', '.join(model.names)}"
            )
        if name in made:
            raise SpecError(
                f"{option(name_of_option, said)} is about {name}, which is given already: give it "
                f"once, by name or by symbol"
            )
        made[name] = value
    return made


def _given(
    said: Mapping[str, Value] | Texts | None,
    argument: str,
    form: str,
    read: Callable[[str, str], Value],
) -> Mapping[str, Value]:
    """What one argument states, by name or symbol.

    Parameters
    ----------
    form
        How a text is written.
    read
        Reads what follows ``NAME=``, from it and from the option that names it in errors.
    """
    if said is None or isinstance(said, Mapping):
        for key, stated in (said or {}).items():
            _check_stated(argument, key, stated)
        return said or {}
    if not isinstance(said, Iterable) or not all(isinstance(text, str) for text in said):
        raise SpecError(f"{option(argument)} is neither a dict nor texts: write {form}")
    made: dict[str, Value] = {}
    for text in [said] if isinstance(said, str) else said:
        name, mark, value = (part.strip() for part in text.partition("="))
        if not (mark and name and value):
            raise SpecError(f"{option(argument, text)}: write {option(argument, form)}")
        if name in made:
            raise SpecError(f"{option(argument, text)}: {name} is given already, give it once")
        made[name] = read(value, option(argument, text))
    return made


def _check_stated(argument: str, name: object, value: object) -> None:
    """Refuse what is stated about a parameter by a mapping in another form than its argument's."""
    if not isinstance(name, str):
        raise SpecError(f"{option(argument)} has the key {name!r}: give a parameter's name")
    if argument == "ties":
        fits = isinstance(value, str)
    elif argument in ("bounds", "prior"):
        fits = isinstance(value, Sequence) and len(value) == 2 and all(map(_is_number, value))
    else:
        fits = _is_number(value)
    if not fits:
        form = {"ties": "a formula", "bounds": "(low, high)", "prior": "(mean, standard deviation)"}
        raise SpecError(
            f"{option(argument)} of {name} is {one_line(repr(value), 80)}: give "
            f"{form.get(argument, 'a number')}"
        )


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _range(text: str, what: str) -> tuple[float, float]:
    low, mark, high = text.partition(":")
    if not mark:
        raise SpecError(f"{what}: write {option('bounds', 'NAME=LOW:HIGH')}")
    lower = number(low, what, infinite=True) if low.strip() else -math.inf
    upper = number(high, what, infinite=True) if high.strip() else math.inf
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
