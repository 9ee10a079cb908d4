"""Fit one model from several starts, and keep where each of them ended."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.fitting.fit import rows_to_fit
from stribeck.fitting.prediction import Prediction, refuse_infinite
from stribeck.fitting.solve import Solution, solve, with_own_load
from stribeck.fitting.stated import solve_under
from stribeck.identify.figures import rms
from stribeck.identify.left_out.rows import scored_rows
from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.ends import Ended
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

#: Outcome of a start that others left behind on few samples.
LEFT = "left after the search on few samples"


@dataclass(frozen=True)
class FittedStart:
    """The end of one of several starts; its errors are those of `Fit`.

    A start that did not continue on all samples has no held-out error.
    """

    model: Model
    rmse: float
    rmse_held_out: float | None
    converged: bool
    outcome: str
    evaluations: int


def fit_each(
    model: Model,
    recording: Recording,
    *,
    starts: int,
    seed: int,
    transient: NDArray[np.bool_],
    effort: Effort,
) -> list[FittedStart | StribeckError]:
    """Fit one model as `fit` does; an error takes the place of a start that failed.

    The best starts continue on all samples. Starts that end at the same place on few samples
    continue as one; their outcome names the start that they merged with.

    Parameters
    ----------
    starts, seed, transient, effort
        As of `fit`.

    Raises
    ------
    FitError
        As of `fit`, where no start could be fitted.
    """
    rows = rows_to_fit(model, recording, transient)
    model, load = with_own_load(model, recording, rows, starts, seed, effort)
    solution = solve(model, recording, rows, load, starts, seed, effort)
    problem = Problem(recording, model, rows, solution.load)
    ended: dict[int, FittedStart | StribeckError] = {}
    fits = []
    for k, end in enumerate(solution.found.ends):
        if end.leader not in ended:
            ended[end.leader] = _said(problem, solution, end, effort)
        fitted = ended[end.leader]
        if isinstance(fitted, FittedStart):
            outcome = fitted.outcome
            if end.leader != k:
                outcome = f"merged with start {end.leader}: {outcome}"
            fitted = replace(fitted, outcome=outcome, evaluations=end.evaluations)
        fits.append(fitted)
    return fits


def _said(
    problem: Problem, solution: Solution, end: Ended, effort: Effort
) -> FittedStart | StribeckError:
    try:
        return _fitted(problem, solution, end, effort)
    except StribeckError as error:
        return error


def _fitted(problem: Problem, solution: Solution, end: Ended, effort: Effort) -> FittedStart:
    search, recording = end.search, problem.recording
    best = search is solution.found.search
    values = solution.values if best else search.values
    model = problem.model.with_values(values)
    problem = Problem(recording, model, problem.rows, problem.load)
    if not end.finished:
        prediction = problem.predict(values)
        refuse_infinite(problem, prediction)
        error = rms((recording.torque - prediction)[scored_rows(recording)])
        return FittedStart(model, error, None, False, LEFT, end.evaluations)
    if model.stated.changes_the_search:
        return _under(problem, replace(solution, values=values), end, effort)
    found = Prediction.of(problem, values, solution.lower, solution.upper, effort)
    converged = solution.converged if best else search.converged
    outcome = solution.outcome if best else search.outcome
    return FittedStart(model, found.rmse, found.rmse_held_out, converged, outcome, end.evaluations)


def _under(problem: Problem, solution: Solution, end: Ended, effort: Effort) -> FittedStart:
    """The end of a start that continues under what is stated about the parameters."""
    solved, under = solve_under(problem.model, problem, solution, "robust", effort, seed=0)
    model = problem.model.with_values(solved.values)
    problem = replace(problem, model=model, load=solved.load, loss_weight=under.loss_weight)
    found = Prediction.of(
        problem, solved.values, solution.lower, solution.upper, effort, under.refit
    )
    errors = found.rmse, found.rmse_held_out
    evaluations = end.evaluations + solved.evaluations - solution.evaluations
    return FittedStart(model, *errors, solved.converged, solved.outcome, evaluations)
