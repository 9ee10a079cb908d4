"""The models of a command on its recording: specs are fitted, stored models evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.base.errors import SpecError, nearest
from stribeck.cli.common import is_model_file, say, stored_model
from stribeck.cli.formulas import Written
from stribeck.cli.unread import refuse_unread
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.scaling import model_for
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def fits_of(
    models: Sequence[str],
    written: Written,
    recording: Recording,
    *,
    starts: int,
    seed: int,
    per_run: Sequence[str] = (),
) -> list[Fit]:
    """The fit of each model argument, then of each law by formula.

    Parameters
    ----------
    per_run
        Names or symbols of parameters with a value in each run, of the models that have them.
    """
    specs: list[str | Model] = [argument for argument in models if not is_model_file(argument)]
    made = [model_for(model, recording) for model in [*specs, *written.by_formula()]]
    if not made:
        unread = dict.fromkeys(("loss", "algorithm"), "with a spec")
        refuse_unread("with model files alone, which are not refitted", unread)
    varied = _varied(per_run, made)
    to_fit = iter(written.choices.applied_to_each(made))
    fits = []

    def fitted(model: Model) -> Fit:
        own = [name for name in varied if name in _names(model)]
        return fit(model, recording, starts=starts, seed=seed, per_run=own)

    for argument in models:
        say(f"{'evaluating' if is_model_file(argument) else 'fitting'} {argument}")
        if is_model_file(argument):
            fits.append(stored_model(argument, recording))
        else:
            fits.append(fitted(next(to_fit)))
    for model in to_fit:
        say(f"fitting {model.own[0].text}")
        fits.append(fitted(model))
    return fits


def _varied(given: Sequence[str], models: Sequence[Model]) -> list[str]:
    """The parameters of `--per-run`, each of which at least one model has."""
    said = [part.strip() for text in given for part in text.split(",") if part.strip()]
    known = {name for model in models for name in _names(model)}
    for name in said:
        if name not in known:
            specs = ", ".join(model.spec for model in models) or "no model"
            raise SpecError(
                f"--per-run {name}: no model that is fitted has this parameter"
                f"{nearest(name, known)}; fitted: {specs}"
            )
    return said


def _names(model: Model) -> set[str]:
    """Names and symbols of the parameters of a model."""
    return {text for p in model.parameters for text in (p.name, p.symbol)}
