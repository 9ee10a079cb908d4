"""Least squares over all samples of a data set, started from a fit to a part in memory."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.fitting.result import Fit
from stribeck.identify.errors.at_bound import at_bound_notes
from stribeck.identify.errors.covariance import correlation_length
from stribeck.identify.errors.estimates import Identified, estimates_by_rows
from stribeck.identify.held_out import Bounded
from stribeck.identify.search.separable import Search, minimise
from stribeck.identify.triangle import Triangle
from stribeck.models.model import Model
from stribeck.models.rigid_body import needs_own_load
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.passes import Groups, StreamedProblem, Told, group_edges
from stribeck.scale.streaming.result import StreamedFit
from stribeck.scale.streaming.sample import Sample
from stribeck.scale.streaming.windows import WINDOW_ROWS, Windows

__all__ = ["streamed_fit"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Largest number of passes of a search.
MOST_PASSES = 40
#: The search ends when the predicted relative decrease of the squared error, times the number of
#: independent samples, is below this value: the step is then a hundredth of the standard error.
SETTLED = 1e-4
#: Largest number of updates of the load of an identified rigid body, and the relative change of the
#: parameters that ends them.
LOAD_ROUNDS, LOAD_STAYS = 4, 1e-5
#: Largest number of groups of samples in a held-out block; standard errors treat groups as
#: independent.
MOST_GROUPS = 20
#: Smallest length of a group, in correlation lengths of the residual.
LENGTHS = 4.0


def streamed_fit(
    data: DataSet,
    sample: Sample,
    start: Fit,
    *,
    told: Told,
    window_rows: int = WINDOW_ROWS,
    tolerance: float | None = None,
) -> StreamedFit:
    """Identify the model of `start` on all samples.

    A model that is linear in its parameters takes one pass, others one pass for each step of the
    search. Held-out error and standard errors come from the last pass.

    Parameters
    ----------
    start : Fit
        A fit to `sample`, which is a part of `data`.
    told
        Called after each window with the samples done, all samples, and the number of the pass.
    tolerance
        The search ends when the predicted relative decrease of the squared error is smaller.
        Default: no parameter would move by more than a hundredth of its standard error.

    Raises
    ------
    FitError
        The predicted torque is not finite at some sample.
    """
    began = time.perf_counter()
    model = start.model
    bounds = np.array([model.bounds[name] for name in model.names])
    length = correlation_length(start.residual[start.rows])
    edges = group_edges(sample.edges, _groups(start, sample, length))
    windows = Windows(data, sample, model, window_rows)
    problem = StreamedProblem(windows, model, edges, told)
    if tolerance is None:
        tolerance = SETTLED * length / int(sample.edges[-1])
    found = _searched(problem, model.values, bounds, tolerance)
    return _result(problem, sample, start, bounds, found, began)


def _result(
    problem: StreamedProblem,
    sample: Sample,
    start: Fit,
    bounds: Array,
    found: Search,
    began: float,
) -> StreamedFit:
    """Compute errors and standard errors at the values found, in one more pass if needed."""
    edges, model = problem.edges, start.model
    groups = _at(problem, found.values)
    parts = _in_order(groups, found.values)
    block = np.searchsorted(sample.edges, edges[groups.number], side="right") - 1
    blocks = [_joined(parts, block == b) for b in range(sample.edges.size - 1)]
    held_out = _held_out(model, found.values, bounds, blocks)
    moving = int(groups.rows.sum())
    square = Triangle.joined(parts).square
    free = np.flatnonzero(bounds[:, 0] < bounds[:, 1])
    seconds = time.perf_counter() - began
    identified = _estimates(model, found.values, bounds, parts, free)
    return StreamedFit(
        model=replace(model, box=groups.ranges).with_values(found.values),
        data=problem.windows.data,
        start=start,
        estimates=identified.estimates,
        rmse=float(np.sqrt(square / moving)),
        rmse_held_out=None if held_out is None else float(np.sqrt(held_out / moving)),
        rows=groups.count,
        moving=moving,
        dropped=groups.dropped,
        time_span=groups.time_span,
        blocks=sample.edges.size - 1,
        converged=found.converged,
        outcome=found.outcome,
        passes=problem.passes,
        seconds=start.seconds + seconds,
        pass_seconds=seconds,
        notes=(*_notes(sample, start, groups), *at_bound_notes(identified.estimates.values())),
        covariance=identified.covariance,
        combinations=identified.combinations,
    )


def _groups(start: Fit, sample: Sample, length: float) -> int:
    """Return the number of groups in a block; each is much longer than the correlation `length`."""
    share = start.rows.size / sample.recording.rows
    moving = share * int(sample.edges[-1]) / (sample.edges.size - 1)
    return int(np.clip(moving / (LENGTHS * length), 1, MOST_GROUPS))


def _searched(problem: StreamedProblem, values: Array, bounds: Array, tolerance: float) -> Search:
    """Search the minimum from `values`.

    If friction depends on the load of an identified rigid body, the load is updated and the search
    repeated until the parameters stay.
    """
    if all(p.linear for p in problem.model.parameters) and not needs_own_load(problem.model):
        return _solved(problem, values, bounds)
    rounds = LOAD_ROUNDS if needs_own_load(problem.model) else 1
    found = Search(values, np.inf, False, "", 0)
    for _ in range(rounds):
        if rounds > 1:
            problem.load_at = values
        found = minimise(
            problem, values, bounds[:, 0], bounds[:, 1], tolerance=tolerance, most=MOST_PASSES
        )
        if not np.isfinite(found.square):
            raise _not_finite(problem)
        moved = np.abs(found.values - values) / (np.abs(values) + np.finfo(float).tiny)
        values = found.values
        if np.all(moved < LOAD_STAYS):
            break
    return found


def _solved(problem: StreamedProblem, values: Array, bounds: Array) -> Search:
    """Return the best linear parameters, in one pass."""
    free = np.flatnonzero(bounds[:, 0] < bounds[:, 1])
    groups = problem.groups(values, free)
    if groups is None:
        raise _not_finite(problem)
    at, (lower, upper) = values[free], bounds[free].T
    found = values.copy()
    step = Triangle.joined(groups.parts).solve(lower - at, upper - at)
    found[free] = np.clip(at + step, lower, upper)
    return Search(found, np.inf, True, "solved directly", 1)


def _not_finite(problem: StreamedProblem) -> FitError:
    return FitError(
        f"{problem.model.spec} predicts no finite torque for some samples of "
        f"{problem.windows.data.path}: leave them out with {option('where')}"
    )


def _at(problem: StreamedProblem, values: Array) -> Groups:
    """The pass at the nonlinear parameters of the solution."""
    curved = [k for k, p in enumerate(problem.model.parameters) if not p.linear]
    latest = problem.latest
    if latest is not None and np.array_equal(latest.values[curved], values[curved]):
        return latest
    assert latest is not None
    made = problem.groups(values, latest.wanted)
    assert made is not None
    return made


def _in_order(groups: Groups, values: Array) -> list[Triangle]:
    """Factors of the groups at the solution, with columns in the order of the parameters."""
    columns = np.argsort(groups.wanted)
    return [Triangle(t.factor[:, columns], t.right, t.rest) for t in groups.moved(values)]


def _joined(parts: list[Triangle], wanted: NDArray[np.bool_]) -> Triangle:
    """The least-squares problem of the selected groups."""
    return Triangle.joined(
        [part for part, is_wanted in zip(parts, wanted, strict=True) if is_wanted]
    )


def _held_out(model: Model, values: Array, bounds: Array, blocks: list[Triangle]) -> float | None:
    """Sum of squares, each block predicted by a fit without it; None with a single block.

    Each fit is one Gauss-Newton step from the solution: exact for linear parameters, and accurate
    for the others, which change little when a tenth of many samples is left out.
    """
    if len(blocks) < 2:
        return None
    refit = Bounded(bounds[:, 0], bounds[:, 1])
    free = np.flatnonzero(bounds[:, 0] < bounds[:, 1])
    total = 0.0
    for k, block in enumerate(blocks):
        others = Triangle.joined([other for j, other in enumerate(blocks) if j != k])
        own = refit.without(block, model)
        total += block.square - block.fall((own.step(values, others) - values)[free])
    return total


def _estimates(
    model: Model, values: Array, bounds: Array, parts: list[Triangle], free: NDArray[np.intp]
) -> Identified:
    """The parameters, with standard errors from the scores of the groups."""
    count = max(free.size, 1)
    jacobian = np.zeros((count * len(parts), values.size))
    jacobian[:, free] = np.concatenate([t.factor for t in parts])
    residual = np.concatenate([t.right for t in parts])
    batch = np.repeat(np.arange(len(parts), dtype=np.uint32), count)
    return estimates_by_rows(model, values, bounds[:, 0], bounds[:, 1], jacobian, residual, batch)


def _notes(sample: Sample, start: Fit, groups: Groups) -> tuple[str, ...]:
    notes = []
    if not sample.whole:
        notes.append(
            f"bounds, velocity noise and the start of the search are from "
            f"{sample.recording.rows} samples in contiguous parts; parameters and errors are from "
            f"all {groups.count} samples"
        )
    if groups.dropped:
        notes.append(f"{groups.dropped} samples with empty, NaN or infinite cells dropped as gaps")
    if start.model.rigid_body:
        notes.append(
            f"identified together with the friction: {' and '.join(start.model.rigid_body)}"
        )
    return tuple(notes)
