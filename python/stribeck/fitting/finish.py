"""Assemble the result of a fit: errors, held-out prediction, notes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.prediction import Prediction
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import Solution
from stribeck.fitting.stated import Under
from stribeck.identify.errors.at_bound import at_bound_notes
from stribeck.identify.errors.uncertainty import Uncertainty, identified
from stribeck.identify.figures import relative_residual
from stribeck.identify.held_out import Refit
from stribeck.identify.left_out.rows import left_out_notes
from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import Effort
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def finish(
    made: Model,
    recording: Recording,
    marked: NDArray[np.bool_],
    rows: NDArray[np.intp],
    load: Array | None,
    solution: Solution,
    effort: Effort,
    uncertainty: Uncertainty,
    seconds: float,
    by: Refit | None = None,
    under: Under | None = None,
) -> Fit:
    problem = Problem(recording, made, rows, load)
    values = made.values
    lower, upper = solution.lower, solution.upper
    if under is not None:
        problem, by = replace(problem, loss_weight=under.loss_weight), under.refit
    found = Prediction.of(problem, values, lower, upper, effort, by)
    if under is None:
        search = solution.found.search
        parameters = identified(problem, values, lower, upper, uncertainty, search)
    else:
        parameters = under.identified(values, uncertainty.errors)
    return Fit(
        model=replace(
            made,
            bounds={
                n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)
            },
            box=operating_box(made, recording, load),
        ).with_values(values),
        recording=recording,
        estimates=parameters.estimates,
        prediction=found.prediction,
        held_out=found.held_out,
        rmse=found.rmse,
        rmse_held_out=found.rmse_held_out,
        relative_residual=None
        if found.rmse_held_out is None
        else relative_residual(recording, recording.torque - found.held_out),
        starts=solution.starts,
        converged=solution.converged,
        outcome=solution.outcome,
        evaluations=solution.evaluations,
        seconds=seconds,
        transient=marked,
        load=load,
        notes=(
            *_notes(made, recording, marked, lower, upper),
            *at_bound_notes(parameters.estimates.values()),
            *parameters.notes,
        ),
        errors=uncertainty.errors,
        covariance=parameters.covariance,
        combinations=parameters.combinations,
        rank=parameters.rank,
        search=solution.found.report,
        under=under,
    )


def _notes(
    made: Model, recording: Recording, marked: NDArray[np.bool_], lower: Array, upper: Array
) -> tuple[str, ...]:
    """What a reader has to know: samples left out, the rigid body, fixed parameters."""
    notes = left_out_notes(recording, marked)
    if made.rigid_body:
        notes += (f"identified together with the friction: {' and '.join(made.rigid_body)}",)
    held = [n for n, a, b in zip(made.names, lower, upper, strict=True) if a == b]
    if held:
        stated = ", ".join(f"{name} = {made.value(name):.6g}" for name in held)
        notes += (f"fixed, not identified: {stated}",)
    return notes
