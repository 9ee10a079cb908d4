"""The stored result of a model identified on one joint and day: plain data that can be pickled."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.loop.improve import improve
from stribeck.diagnosis.residual.noise_floor import noise_floor
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import batches, correlation_length, sandwich
from stribeck.identify.problem import Problem
from stribeck.identify.stated.choices import Choices
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import parse_model_file
from stribeck.recording.recording import Recording

#: In place of a model: diagnose and add effects until the residual is noise.
IMPROVE = "improve"


@dataclass(frozen=True)
class Found:
    """An effect found missing, its confidence, and the effects indistinguishable from it."""

    effect: str
    confidence: float
    tied: tuple[str, ...]


@dataclass(frozen=True)
class Value:
    """A parameter; `stderr` is None if it is at its bound, fixed or not identifiable."""

    name: str
    symbol: str
    unit: str
    value: float
    stderr: float | None


@dataclass(frozen=True)
class Identified:
    """A model identified on one joint and day.

    Attributes
    ----------
    model, model_file
        Spec, and the model file as text (TOML).
    found
        Effects in the order in which they were added; none where one model was fitted.
    unit
        Of torque and of all errors.
    noise_floor
        None where it cannot be estimated.
    covariance
        Covariance of the parameters, p x p, row by row; 0 where a parameter has no standard error.
    notes
        How the recording was understood.
    """

    model: str
    model_file: str
    found: tuple[Found, ...]
    rows: int
    rows_scored: int
    unit: str
    rmse: float
    rmse_held_out: float | None
    noise_floor: float | None
    converged: bool
    parameters: tuple[Value, ...]
    covariance: tuple[float, ...]
    notes: tuple[str, ...]


def identify(
    recording: Recording,
    model: str,
    base: str,
    starts: int = 20,
    seed: int = 0,
    choices: Choices | None = None,
) -> Identified:
    """Fit `model` to a recording, or improve `base` if `model` is ``"improve"``.

    Parameters
    ----------
    model, base
        A spec, or the text of a model file whose values are the first start.
    choices
        What is stated about parameters.
    """
    stated = (choices or Choices()).arguments()
    if model != IMPROVE:
        fitted = fit(start_model(model), recording, starts=starts, seed=seed, **stated)
        return _identified(fitted, (), noise_floor(fitted).value)
    improvement = improve(start_model(base), recording, starts=starts, seed=seed, **stated)
    found = tuple(
        Found(step.finding.effect, step.finding.confidence, step.finding.indistinguishable_from)
        for step in improvement.steps
    )
    return _identified(improvement.final, found, improvement.noise_floor.value)


def start_model(text: str) -> str | Model:
    """Return a spec unchanged, or the model in the text of a model file."""
    return parse_model_file(text, Path("the model")).model if "\n" in text else text


def _identified(fitted: Fit, found: tuple[Found, ...], floor: float | None) -> Identified:
    return Identified(
        model=fitted.model.spec,
        model_file=ModelFile.of(fitted).to_toml(),
        found=found,
        rows=fitted.recording.rows,
        rows_scored=int(fitted.scored.sum()),
        unit=fitted.model.torque_unit,
        rmse=fitted.rmse,
        rmse_held_out=fitted.rmse_held_out,
        noise_floor=floor,
        converged=fitted.converged,
        parameters=tuple(
            Value(e.name, e.symbol, e.unit, e.value, e.stderr) for e in fitted.estimates.values()
        ),
        covariance=tuple(float(x) for x in _covariance(fitted).ravel()),
        notes=tuple(dict.fromkeys([*fitted.recording.notes, *fitted.notes])),
    )


def _covariance(fitted: Fit) -> NDArray[np.float64]:
    """Covariance [p, p] of the parameters; its diagonal is the square of the standard errors."""
    problem = Problem(fitted.recording, fitted.model, fitted.rows, fitted.load)
    residual, jacobian = map(problem.weighted, problem.linearise(fitted.model.values))
    free = np.array([e.stderr is not None for e in fitted.estimates.values()], dtype=bool)
    batch = batches(residual.size, correlation_length(residual))
    return sandwich(jacobian, residual, batch, free)
