"""A fit with parameters that have a value of their own in each run."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, SpecError, nearest, option
from stribeck.fitting.prediction import Prediction
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import Solution, solve
from stribeck.identify.errors.at_bound import at_bound_notes
from stribeck.identify.errors.estimates import Estimate, Identified
from stribeck.identify.errors.uncertainty import Uncertainty, identified
from stribeck.identify.figures import relative_residual
from stribeck.identify.per_run import OfRuns, PerRunProblem, Widened
from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.separable import CAUTIOUS, Search, minimise
from stribeck.identify.stated.choices import refuse_statements
from stribeck.models.model import Model
from stribeck.models.rigid_body import needs_own_load
from stribeck.recording.recording import Recording

__all__ = ["named_per_run", "refuse_beside", "with_own_values"]

Array = NDArray[np.float64]

#: Samples of a run beyond its own parameters that are needed at least.
_SPARE = 2


def named_per_run(given: str | Collection[str], model: Model, recording: Recording) -> list[str]:
    """The names of the parameters of each run, in the order of the model.

    Raises
    ------
    SpecError
        The model has no such parameter, it is held, or other things are asked for that need one
        value.
    FitError
        There is one run only, or friction depends on a rigid body that is identified.
    """
    texts = [given] if isinstance(given, str) else given
    if not (isinstance(texts, Collection) and all(isinstance(text, str) for text in texts)):
        raise SpecError(f"`per_run` is {given!r:.40}: give the name of a parameter, or several")
    said = [part.strip() for text in texts for part in text.split(",") if part.strip()]
    if not said:
        return []
    of_symbol = {p.symbol: p.name for p in model.parameters}
    names = {}
    for name in said:
        known = name if name in model.names else of_symbol.get(name)
        if known is None:
            hint = nearest(name, (*model.names, *of_symbol))
            raise SpecError(
                f"{option('per_run', name)}: {model.spec} has no parameter '{name}'"
                f"{hint or '; it has ' + ', '.join(model.names)}"
            )
        low, high = model.limits.get(known, (0.0, 1.0))
        if low == high:
            raise SpecError(f"{option('per_run', name)}: {known} is held, so it has one value")
        names[known] = True
    refuse_statements(model, option("per_run"))
    if recording.runs < 2:
        raise FitError(
            f"{recording.path}: {option('per_run', ','.join(said))} needs several runs, there is "
            "one: give several files, or name the run column"
        )
    if needs_own_load(model):
        raise FitError(
            f"{model.spec} depends on a load that is identified with it, from one value of each "
            f"parameter: give a load_torque, or leave out {option('per_run')}"
        )
    return [name for name in model.names if name in names]


def with_own_values(
    shared: Fit,
    solution: Solution,
    made: Model,
    varied: list[str],
    searched: tuple[int, int, Effort],
    by: Uncertainty,
) -> Fit:
    """The fit in which the `varied` parameters have one value in each run.

    Where a run is held out as a whole it is predicted with the means of the other runs. The model
    of the fit has the means over all runs.

    Parameters
    ----------
    shared, solution
        With one value of each parameter.
    made
        The model before any fit.
    searched
        Starts, seed and effort.

    Raises
    ------
    FitError
        A run has too few moving samples.
    """
    began = time.perf_counter()
    recording, model, effort = shared.recording, shared.model, searched[2]
    widened = Widened(model, tuple(varied), recording.run_names)
    problem = PerRunProblem.of(Problem(recording, model, shared.rows, solution.load), widened)
    _check_runs(recording, problem.rows, len(varied) + _SPARE)
    lower, upper = widened.widened(solution.lower), widened.widened(solution.upper)
    found = _searched(problem, solution, made, searched)
    refit = OfRuns(lower, upper, varied=tuple(widened.of_varied()))
    predicted = Prediction.of(problem, found.values, lower, upper, effort, refit)
    parameters = identified(problem, found.values, lower, upper, by)
    held_out = recording.torque - predicted.held_out
    return replace(
        shared,
        model=model.with_values(widened.mean(found.values)),
        estimates=_means(widened, parameters),
        per_run=_of_runs(widened, parameters),
        prediction=predicted.prediction,
        held_out=predicted.held_out,
        rmse=predicted.rmse,
        rmse_held_out=predicted.rmse_held_out,
        relative_residual=None
        if predicted.rmse_held_out is None
        else relative_residual(recording, held_out),
        converged=found.converged,
        outcome=found.outcome,
        evaluations=shared.evaluations + found.evaluations,
        seconds=shared.seconds + time.perf_counter() - began,
        covariance=parameters.covariance,
        combinations=parameters.combinations,
        rank=parameters.rank,
        notes=(*_notes(shared, recording, varied), *at_bound_notes(parameters.estimates.values())),
    )


def _searched(
    problem: PerRunProblem, solution: Solution, made: Model, searched: tuple[int, int, Effort]
) -> Search:
    """The best search, from the values that all runs share and from those of the longest run.

    What differs from run to run distorts the shared values, which may lead to a poor minimum.
    """
    recording, widened = problem.recording, problem.widened
    longest = int(np.argmax(np.bincount(recording.run[problem.rows])))
    rows = problem.rows[recording.run[problem.rows] == longest]
    alone = solve(made, recording, rows, None, *searched)
    lower, upper = widened.widened(solution.lower), widened.widened(solution.upper)
    searches = [
        minimise(problem, widened.widened(values), lower, upper, damping=CAUTIOUS)
        for values in (solution.values, alone.values)
    ]
    best = min(searches, key=lambda search: search.square)
    evaluations = alone.evaluations + sum(search.evaluations for search in searches)
    return replace(best, evaluations=evaluations)


def refuse_beside(varied: list[str], errors: str, estimator: str, *, passive: bool) -> None:
    """Raise `SpecError` for what needs one value of each parameter, where some are `varied`."""
    for is_given, what in (
        (passive, option("passive")),
        (estimator != "ls", option("estimator", estimator)),
        (errors not in ("robust", "independent"), option("errors", errors)),
    ):
        if is_given and varied:
            raise SpecError(f"{what} needs one value of each parameter: omit {option('per_run')}")


def _check_runs(recording: Recording, rows: NDArray[np.intp], least: int) -> None:
    count = np.bincount(recording.run[rows], minlength=recording.runs)
    short = int(np.argmin(count))
    if count[short] < least:
        raise FitError(
            f"{recording.path}: run '{recording.run_names[short]}' has {count[short]} moving "
            f"samples, parameters of its own need {least}: leave the run out, or "
            f"{option('per_run')}"
        )


def _notes(shared: Fit, recording: Recording, varied: list[str]) -> tuple[str, ...]:
    """What a reader has to know, in place of the notes on bounds of the shared values."""
    of_shared = at_bound_notes(shared.estimates.values())
    kept = [note for note in shared.notes if note not in of_shared]
    pairs = np.unique(np.stack([recording.run, recording.block]), axis=1).shape[1]
    by_run = pairs == recording.runs
    names = ", ".join(varied)
    means = f"{names}: one value in each run; the model itself has their mean"
    if by_run:
        return (*kept, f"{means}, with which held-out runs are predicted")
    return (*kept, means)


def _of_runs(widened: Widened, found: Identified) -> Mapping[str, Mapping[str, Estimate]]:
    """The estimates of each varied parameter, by run."""
    return {
        name: {run: replace(found.estimates[f"{name}[{run}]"], name=name) for run in widened.runs}
        for name in widened.varied
    }


def _means(widened: Widened, found: Identified) -> dict[str, Estimate]:
    """The estimates of the shared parameters, and of the means over the runs of the others."""
    made = {}
    for p in widened.base.parameters:
        if p.name not in widened.varied:
            made[p.name] = found.estimates[p.name]
            continue
        of_runs = [found.estimates[f"{p.name}[{run}]"] for run in widened.runs]
        value = float(np.mean([e.value for e in of_runs]))
        first = of_runs[0]
        error = _error_of_mean(found, [f"{p.name}[{run}]" for run in widened.runs])
        quantile = 0.0
        if first.ci95 is not None and first.stderr:
            quantile = (first.ci95[1] - first.ci95[0]) / (2.0 * first.stderr)
        made[p.name] = Estimate.symmetric(
            cast(Any, p),
            value,
            error if quantile else None,
            quantile,
            (first.lower, first.upper),
            at_bound=all(e.at_bound for e in of_runs),
            identifiable=all(e.identifiable for e in of_runs),
        )
    return made


def _error_of_mean(found: Identified, names: list[str]) -> float | None:
    """Standard error of the mean of several parameters; None where one has none."""
    if not all(name in found.covariance.names for name in names):
        return None
    at = [found.covariance.names.index(name) for name in names]
    return float(np.sqrt(found.covariance.values[np.ix_(at, at)].mean()))
