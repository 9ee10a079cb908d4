"""The torque that a model predicts on a recording, fitted and held out, with its errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.identify.figures import rms
from stribeck.identify.held_out import Refit, held_out_prediction
from stribeck.identify.left_out.rows import counted_rows, scored_rows
from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import Effort
from stribeck.models.parts import friction_parts

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Prediction:
    """Predicted torque of every sample, fitted and held out, and the RMSE of both."""

    prediction: Array
    held_out: Array
    rmse: float
    rmse_held_out: float | None

    @classmethod
    def of(
        cls,
        problem: Problem,
        values: Array,
        lower: Array,
        upper: Array,
        effort: Effort,
        by: Refit | None = None,
    ) -> Prediction:
        """Predict with `values`.

        Raises `FitError` if a torque is not finite, or if a bristle has no dry friction to hold."""
        prediction = _finite_prediction(problem, values)
        held_out, _ = held_out_prediction(
            problem, values, lower, upper, exact=effort.exact, by=by, predicted=prediction
        )
        return cls._of(problem, prediction, held_out)

    @classmethod
    def from_torque(cls, problem: Problem, values: Array, held_out: Array) -> Prediction:
        """Predict with `values`, given the `held_out` torque [n]; raises as `of`."""
        return cls._of(problem, _finite_prediction(problem, values), held_out)

    @classmethod
    def _of(cls, problem: Problem, prediction: Array, held_out: Array) -> Prediction:
        recording = problem.recording
        scored = scored_rows(recording)
        residual = recording.torque - held_out
        blocks = np.unique(recording.block[scored]).size
        has_held_out = blocks >= 2 and bool(np.all(np.isfinite(residual[scored])))
        counted = counted_rows(recording)
        rmse = rms((recording.torque - prediction)[scored])
        return cls(prediction, held_out, rmse, rms(residual[counted]) if has_held_out else None)


def _finite_prediction(problem: Problem, values: Array) -> Array:
    """Predicted torque of every sample [n]; raises as `Prediction.of`."""
    prediction = problem.predict(values)
    refuse_infinite(problem, prediction)
    if problem.model.has("presliding"):
        for own in problem.by_run(values):
            _refuse_slack_bristle(own)
    return prediction


def refuse_infinite(problem: Problem, prediction: Array) -> None:
    """Raise `FitError` at the first sample whose predicted torque is not finite."""
    wrong = np.flatnonzero(~np.isfinite(prediction))
    if wrong.size == 0:
        return
    model, recording = problem.model, problem.recording
    row = wrong[0]
    values = ", ".join(f"{n} = {v:.6g}" for n, v in zip(model.names, model.values, strict=True))
    advice = "give other starts or bounds" if model.own else "check them"
    raise FitError(
        f"{model.spec} predicts no finite torque on {recording.path} at t = "
        f"{recording.time[row]:.6g} s (velocity {recording.velocity[row]:.6g} "
        f"{recording.position_unit}/s) with {values}: {advice}"
    )


def _refuse_slack_bristle(problem: Problem) -> None:
    """Raise `FitError` at the sample with the least dry friction D if D <= 0 there.

    A bristle needs D > 0: its deflection is bounded by |z| <= D/s0.
    """
    recording, moving = problem.recording, problem.recording.moving
    if problem.span is not None:
        inside = np.zeros_like(moving)
        inside[slice(*problem.span)] = True
        moving = moving & inside
    if not moving.any():
        return
    load = problem.load if recording.load_torque is None else recording.load_torque
    dry = friction_parts(problem.model, recording, load, moving)["dry"]
    worst = int(np.argmin(dry))
    if dry[worst] <= 0:
        velocity = recording.velocity[moving][worst]
        smoothed = (
            "; a smoothed sign is a factor atan(k*v) or tanh(k*v), without abs: the bristle takes "
            "its place"
        )
        raise FitError(
            f"{problem.model.spec} has a bristle, but its dry friction is {dry[worst]:.3g} "
            f"{problem.model.torque_unit} at t = {recording.time[moving][worst]:.4g} s (velocity "
            f"{velocity:.3g} {recording.position_unit}/s): remove the bristle, or the effect "
            f"that makes dry friction negative{smoothed if problem.model.own else ''}"
        )
