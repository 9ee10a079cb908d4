"""Compare a model with a recording without refitting it."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

import numpy as np

from stribeck.base.arguments import door
from stribeck.base.checks import LARGEST
from stribeck.base.errors import FitError, option
from stribeck.fitting.evaluated import Evaluated
from stribeck.fitting.predict import predicted
from stribeck.fitting.result import Fit
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.figures import relative_residual, rms
from stribeck.identify.left_out.rows import scored_rows
from stribeck.identify.scaling import rigid_body_terms
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one


@door(model=("a model", Model))
def evaluate(
    model: Model,
    recording: Recordings,
    *,
    fitted_on: str | Collection[str] | None = None,
    stderr: Mapping[str, float] | None = None,
) -> Fit:
    """Compare a model with a recording without refitting it.

    Parameters
    ----------
    recording : Recording or sequence of them
        Several are runs of one joint.
    fitted_on : str or collection of str
        SHA-256 of the files that the model was fitted on; on one of these there is no held-out
        figure.

    Raises
    ------
    FitError
        The model is of another kind of joint, or the recording lacks a channel that it reads.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> model = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> found = sb.evaluate(model, recording)
    >>> found.model.value("coulomb_friction"), found.rmse > 0.2
    (2.0, True)
    """
    began = time.perf_counter()
    recording = as_one(recording)
    prediction, load = predicted(model, recording)
    if not float(np.max(np.abs(prediction), initial=0.0)) <= LARGEST:
        raise FitError(
            f"{model.spec} predicts a torque beyond {LARGEST:g} on {recording.path}: correct the "
            f"values of the model"
        )
    residual = recording.torque - prediction
    error = rms(residual[scored_rows(recording)])
    known = {fitted_on} if isinstance(fitted_on, str) else set(fitted_on or ())
    same = not known.isdisjoint(recording.hashes)
    return Fit(
        model=model,
        recording=recording,
        estimates=_stored(model, stderr or {}),
        prediction=prediction,
        held_out=prediction,
        rmse=error,
        rmse_held_out=None if same else error,
        relative_residual=None if same else relative_residual(recording, residual),
        starts=0,
        converged=True,
        outcome="not refitted",
        evaluations=0,
        seconds=time.perf_counter() - began,
        transient=np.zeros(recording.time.size, dtype=bool),
        load=load,
        rank=None if same else 0,
        notes=_without_load(model, recording),
    )


def _without_load(model: Model, recording: Recording) -> tuple[str, ...]:
    """A note on a load torque that neither the model nor the recording gives."""
    known = (*model.effects, *model.rigid_body)
    lacking = [term for term in rigid_body_terms(recording) if term not in known]
    if model.rigid_body or not lacking:
        return ()
    return (
        f"{model.spec} was stored without {' and '.join(lacking)}, and no load torque is recorded: "
        f"the torque that these need counts as an error",
    )


def evaluated_on(fitted: Fit, recordings: Iterable[Recording]) -> Fit:
    """The fit with its errors on recordings that it was not fitted to.

    Raises
    ------
    FitError
        It was fitted to one of them.
    """
    made = []
    for recording in recordings:
        refuse_fitted_on(recording, fitted.recording.hashes)
        made.append(evaluated(fitted.model, recording))
    return replace(fitted, evaluated=tuple(made))


def evaluated(model: Model, recording: Recording) -> Evaluated:
    """The error of a model on a recording of the same kind of joint."""
    judged = evaluate(model, recording)
    rows = int(scored_rows(recording).sum())
    return Evaluated(recording.path, rows, judged.rmse, judged.relative_residual)


def refuse_fitted_on(recording: Recording, hashes: Collection[str]) -> None:
    """Refuse to judge a model on a recording that it was fitted to.

    Parameters
    ----------
    hashes
        SHA-256 of the files that the model was fitted to.

    Raises
    ------
    FitError
        One of them is a file of the recording.
    """
    if not set(hashes).isdisjoint(recording.hashes):
        raise FitError(
            f"{recording.path}: the model is fitted to it, so that its error there judges "
            f"nothing: give another recording with {option('evaluate')}"
        )


def _stored(model: Model, stderr: Mapping[str, float]) -> dict[str, Estimate]:
    """The parameters of a model with their known standard errors, by name."""
    return {
        p.name: Estimate(
            p.name,
            p.symbol,
            float(value),
            p.unit,
            stderr.get(p.name),
            None,
            False,
            True,
            *model.bounds.get(p.name, (-np.inf, np.inf)),
        )
        for p, value in zip(model.parameters, model.values, strict=True)
    }
