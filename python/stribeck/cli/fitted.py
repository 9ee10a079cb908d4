"""The models of a command on its recording: specs are fitted, stored models evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.cli.common import is_model_file, say, stored_model
from stribeck.cli.formulas import Written
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.scaling import model_for
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def fits_of(
    models: Sequence[str], written: Written, recording: Recording, *, starts: int, seed: int
) -> list[Fit]:
    """The fit of each model argument, then of each law by formula."""
    specs: list[str | Model] = [argument for argument in models if not is_model_file(argument)]
    made = [model_for(model, recording) for model in [*specs, *written.by_formula()]]
    to_fit = iter(written.choices.applied_to_each(made))
    fits = []
    for argument in models:
        say(f"note: {argument} ...")
        if is_model_file(argument):
            fits.append(stored_model(argument, recording))
        else:
            fits.append(fit(next(to_fit), recording, starts=starts, seed=seed))
    for model in to_fit:
        say(f"note: {model.own[0].text} ...")
        fits.append(fit(model, recording, starts=starts, seed=seed))
    return fits
