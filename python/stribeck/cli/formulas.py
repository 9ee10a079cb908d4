"""Model options: laws and effects by formula, and what is stated about parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import click

from stribeck.base.errors import SpecError, nearest
from stribeck.cli.choices import CHOICE_OPTIONS, taken_choices
from stribeck.cli.common import is_model_file, say
from stribeck.cli.options import Command, Values, gathered
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.scaling import model_for
from stribeck.identify.stated.choices import Choices
from stribeck.models.build import law, model
from stribeck.models.formula_law import (
    LAW,
    FormulaTerms,
    check_terms,
    declarations,
    effect_terms,
    is_formula,
)
from stribeck.models.model import Model
from stribeck.models.reader import read_model_file
from stribeck.recording.recording import Recording

_LAW = click.option(
    "--law",
    "laws",
    multiple=True,
    metavar="FORMULA",
    help="A law by formula: 'c1*v + c2*tanh(v/c3)*abs(load)'.",
)
_EFFECT = click.option(
    "--effect",
    "effects",
    multiple=True,
    metavar="EFFECT",
    help="Add an effect to the model: its id, or 'NAME = FORMULA'.",
)
_PARAMETER = click.option(
    "--parameter",
    "parameters",
    multiple=True,
    metavar="TEXT",
    help="Unit, bounds and start of a formula's parameter: 'c3: rad/s, 0.001..10, start 0.1'.",
)


candidate_option = click.option(
    "--candidate",
    "candidates",
    multiple=True,
    metavar="'NAME = FORMULA'",
    help="An effect by formula, as a further candidate.",
)


def check_candidates(texts: tuple[str, ...]) -> None:
    """Refuse candidates that are not effects by formula."""
    for text in texts:
        check_terms(effect_terms(text))


@dataclass(frozen=True)
class Written:
    """The model options of a command."""

    laws: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    choices: Choices = field(default_factory=Choices)

    def model(self, argument: str | None) -> Model:
        """The model of a command: a spec, a model file, a formula, or the law of `--law`.

        It has the added effects and the declared parameters of its formulas.
        """
        given = [text for text in (argument, *self.laws) if text is not None]
        if not given:
            raise SpecError(
                "no model is given: name a law of `stribeck models` or a model file (in fit with "
                "--model), or write a law with --law FORMULA"
            )
        if len(given) > 1:
            raise SpecError(f"one model is needed, {len(given)} are given: {', '.join(given)}")
        made = _model(given[0])
        for effect in self.effects:
            made = made.with_effect(effect, {})
        return self._declared([made])[0]

    def by_formula(self) -> list[Model]:
        """The models of all `--law`; unnamed ones are numbered from the second on."""
        named: list[str] = []
        for text in self.laws:
            taken = [text.partition("=")[0].strip() for text in named]
            number = len(taken) + 1
            free = LAW if LAW not in taken else f"{LAW}_{number}"
            named.append(text if "=" in text else f"{free} = {text}")
        return self._declared([law(text) for text in named])

    def _declared(self, models: list[Model]) -> list[Model]:
        """The models with the declared parameters of their formulas."""
        said = declarations(self.parameters)
        known = {symbol for made in models for terms in made.own for symbol in terms.symbols}
        for symbol, _ in said:
            if symbol not in known:
                has = f"; there are {', '.join(sorted(known))}" if known else ""
                raise SpecError(
                    f"--parameter {symbol}: no formula has this parameter"
                    f"{nearest(symbol, sorted(known)) or has}"
                )

        def heard(terms: FormulaTerms) -> FormulaTerms:
            own = tuple(row for row in said if row[0] in terms.symbols)
            return replace(terms, declared=(*terms.declared, *own))

        return [replace(made, own=tuple(map(heard, made.own))) for made in models]


def _model(argument: str) -> Model:
    if is_model_file(argument):
        return read_model_file(argument).model
    return law(argument) if is_formula(argument) else model(argument)


def written_fit(
    argument: str | None,
    written: Written,
    recording: Recording,
    later: Mapping[str, str] | None = None,
    **options: Any,
) -> Fit:
    """Fit the model of a command; a model file gives the start values.

    Parameters
    ----------
    later
        Parameters that effects may bring later, as `Choices.applied` takes them.
    """
    made = written.model(argument)
    if argument is not None and is_model_file(argument):
        say(f"note: the parameters of {argument} are refitted to {recording.path}")
    stated = written.choices.applied(model_for(made, recording), later)
    return fit(stated, recording, **options)


def formula_options(command: Command) -> Command:
    """Add `--law`, `--parameter` and the choices; the command receives them as `written`."""
    return gathered(command, [_LAW, _PARAMETER, *CHOICE_OPTIONS], "written", _written)


def model_options(command: Command) -> Command:
    """Add all model options; the command receives them as `written`."""
    return gathered(command, [_LAW, _EFFECT, _PARAMETER, *CHOICE_OPTIONS], "written", _written)


def _written(values: Values) -> Written:
    texts = {name: values.pop(name, ()) for name in ("laws", "effects", "parameters")}
    return Written(**texts, choices=taken_choices(values))
