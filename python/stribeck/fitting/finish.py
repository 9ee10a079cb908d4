"""Assemble the result of a fit: errors, held-out prediction, notes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.prediction import Prediction
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import Solution
from stribeck.identify.estimates import Errors, estimates
from stribeck.identify.figures import relative_residual
from stribeck.identify.held_out import Refit
from stribeck.identify.problem import Problem
from stribeck.identify.search import Effort
from stribeck.identify.transients import stretches
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
    errors: Errors,
    seconds: float,
    by: Refit | None = None,
) -> Fit:
    problem = Problem(recording, made, rows, load)
    values = made.values
    lower, upper = solution.lower, solution.upper
    found = Prediction.of(problem, values, lower, upper, effort, by)
    notes: tuple[str, ...] = ()
    if marked.any():
        spans = ", ".join(f"{a:.1f}-{b:.1f} s" for a, b in stretches(recording, marked))
        notes = (
            f"no friction model explains the motion at {spans} (an approach move or an "
            f"abrupt stop?): scored, but excluded from the fit",
        )
    if made.rigid_body:
        notes += (f"identified together with the friction: {' and '.join(made.rigid_body)}",)
    held = [n for n, a, b in zip(made.names, lower, upper, strict=True) if a == b]
    if held:
        stated = ", ".join(f"{name} = {made.value(name):.6g}" for name in held)
        notes += (f"fixed, not identified: {stated}",)
    return Fit(
        model=replace(
            made,
            bounds={
                n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)
            },
            box=operating_box(made, recording, load),
        ).with_values(values),
        recording=recording,
        estimates=estimates(problem, values, lower, upper, errors),
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
        notes=notes,
        errors=errors,
    )
