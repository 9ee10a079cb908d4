"""Refit by instrumental variables, starting from the fit by least squares."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from stribeck.fitting.exogenous import instruments_of
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.prediction import Prediction
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import Solution
from stribeck.identify.errors.at_bound import at_bound_notes
from stribeck.identify.errors.estimates import Identified, estimates_by_rows
from stribeck.identify.figures import relative_residual, rms
from stribeck.identify.instrumental.exogeneity import stroke_batches
from stribeck.identify.instrumental.instruments import Instruments, fitted_columns
from stribeck.identify.search.separable import Search
from stribeck.models.rigid_body import needs_own_load, own_load

#: Most rounds of values and identified load torque, and the change at which they end.
ROUNDS, SETTLED = 8, 1e-5

NOTE = (
    "fitted by instrumental variables: the prediction passes on the noise of the measured motion, "
    "so its error is larger than that of least squares"
)


def instrumented(squares: Fit, solution: Solution) -> Fit:
    """Refit by instrumental variables.

    Parameters
    ----------
    squares
        The fit by least squares, whose values are the start.
    solution
        Its bounds.
    """
    began = time.perf_counter()
    found, instruments, evaluations = _searched(squares, solution)
    model = squares.model.with_values(found.values)
    recording, load = squares.recording, instruments.problem.load
    instruments = Instruments(
        replace(instruments.problem, model=model), replace(instruments.along, model=model)
    )
    lower, upper = solution.lower, solution.upper
    held_out = instruments.held_out(found.values, lower, upper)
    made = Prediction.from_torque(
        replace(instruments.problem, rows=squares.rows), found.values, held_out
    )
    identified = _identified(instruments, found, solution, squares)
    test = squares.exogeneity
    if test is not None:
        changed = {n: squares.model.value(n) - model.value(n) for n in test.bias}
        test = replace(test, bias=changed)
    return replace(
        squares,
        model=replace(model, box=operating_box(model, recording, load)),
        estimates=identified.estimates,
        covariance=identified.covariance,
        combinations=identified.combinations,
        # Information criteria compare fits by least squares.
        rank=None,
        prediction=made.prediction,
        held_out=made.held_out,
        rmse=made.rmse,
        rmse_held_out=made.rmse_held_out,
        relative_residual=None
        if made.rmse_held_out is None
        else relative_residual(recording, recording.torque - held_out),
        converged=squares.converged and found.converged,
        outcome=squares.outcome if found.converged else found.outcome,
        evaluations=squares.evaluations + evaluations,
        seconds=squares.seconds + time.perf_counter() - began,
        load=load,
        notes=_notes(squares, identified),
        estimator="iv",
        tested=test,
    )


def _searched(squares: Fit, solution: Solution) -> tuple[Search, Instruments, int]:
    """The solution, its instruments and the evaluations; a load torque is identified with it."""
    recording, rows, model, load = squares.recording, squares.rows, squares.model, squares.load
    evaluations = 0
    for _ in range(ROUNDS):
        instruments = instruments_of(model, recording, rows, load)
        found = instruments.search(model.values, solution.lower, solution.upper)
        evaluations += found.evaluations
        model = model.with_values(found.values)
        if not needs_own_load(model):
            return found, instruments, evaluations
        renewed = own_load(model, recording)
        assert renewed is not None and load is not None
        moved = rms(renewed - load) / (rms(renewed) or 1.0)
        load = renewed
        if moved < SETTLED:
            break
    return found, instruments, evaluations


def _notes(squares: Fit, identified: Identified) -> tuple[str, ...]:
    """The notes of least squares, with the parameters that are now at a bound."""
    before = at_bound_notes(squares.estimates.values())
    kept = [note for note in squares.notes if note not in before]
    return (*kept, NOTE, *at_bound_notes(identified.estimates.values()))


def _identified(
    instruments: Instruments, found: Search, solution: Solution, squares: Fit
) -> Identified:
    values = found.values
    residual, jacobian, columns = instruments.linearise(values, np.arange(values.size))
    rows = instruments.problem.rows
    batch = stroke_batches(instruments.along.recording, rows, residual)
    return estimates_by_rows(
        squares.model,
        values,
        solution.lower,
        solution.upper,
        fitted_columns(columns, jacobian, residual),
        residual,
        None if squares.errors == "independent" else batch,
    )
