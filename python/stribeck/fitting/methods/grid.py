"""Linear regression inside a grid over the nonlinear parameters, with absolute error.

Bittencourt et al. 2010, eqs 5-6: a friction law tau = f(v, theta2) theta1 is linear in theta1 for
given theta2. Each point of a grid over theta2 is a regression; the one whose sum of absolute errors
is least is the answer. A few wrong measurements do not move it, as they move least squares.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, SpecError, nearest
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.methods.estimates import estimates, reached_bounds
from stribeck.fitting.methods.least_absolute import least_absolute, least_total, standard_errors
from stribeck.fitting.methods.ranges import Ranges
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.result import Fit
from stribeck.identify.covariance import seen
from stribeck.identify.estimates import Estimate
from stribeck.identify.figures import relative_residual, rms
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import model_for
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Rows that the regressions use; more are thinned evenly. A programme's time grows faster than
#: its rows, and steady-state points are few.
MOST_ROWS = 500
#: A larger grid would take minutes to hours.
MOST_POINTS = 20_000
#: Points of the grid along each nonlinear parameter, by their number.
COUNTS = {1: 120, 2: 25, 3: 10}
#: After the grid, so many finer ones about its best point, of so many points a parameter.
ROUNDS, FINER = 8, 5


@dataclass(frozen=True)
class Axis:
    """One parameter of the grid: from `lower` to `upper`, evenly in its logarithm if positive."""

    lower: float
    upper: float
    count: int


def grid_fit(
    spec: str | Model, recording: Recording, *, grid: Mapping[str, Axis] | None = None
) -> Fit:
    """Identify a static law by linear regression in a grid, with least absolute error.

    Parameters
    ----------
    spec : str or Model
        A law without a state, ``"m0"`` or ``"bittencourt_a"``; a model's values are not used.
    recording : Recording
        Best steady-state points. Of more than 500 moving rows, 500 evenly chosen ones are used:
        the sum of absolute errors is theirs, RMSE and held-out error are over all moving rows.
    grid : mapping of parameter name (or symbol) to Axis, optional
        Ranges and counts; default: the catalog's bounds, 120, 25 or 10 points a parameter where
        there are 1, 2 or 3 of them. About its best point the grid is refined until it no longer
        matters; the range is never left.

    Returns
    -------
    Fit
        Standard errors are those of median regression (Koenker and Bassett 1978).

    Raises
    ------
    SpecError
        A grid over a parameter that the law does not have, or that is linear.
    FitError
        A law with a state; too many nonlinear parameters; too few rows; a channel that is missing.

    Examples
    --------
    >>> speeds = Axis(1.0, 50.0, 60)
    >>> points = sb.read("points.csv")  # doctest: +SKIP
    >>> grid = {"stribeck_velocity": speeds}
    >>> grid_fit("bittencourt_a", points, grid=grid)  # doctest: +SKIP
    """
    began = time.perf_counter()
    made = _static_model(spec, recording)
    rows = np.flatnonzero(recording.moving)
    if rows.size < len(made.names) + 2:
        raise FitError(
            f"{recording.path} has {rows.size} rows that move, {made.spec} needs at least "
            f"{len(made.names) + 2}: record more motion"
        )
    whole = Problem(recording, made, rows)
    lower, upper, count = _ranges(made, recording, grid or {})
    search = _GridSearch(whole.thinned(MOST_ROWS), lower, upper, count)
    values = search.best()
    made = replace(
        made,
        bounds={n: (float(a), float(b)) for n, a, b in zip(made.names, lower, upper, strict=True)},
        box=operating_box(made, recording, None),
    ).with_values(values)
    return replace(_as_fit(made, whole, search), seconds=time.perf_counter() - began)


def _static_model(spec: str | Model, recording: Recording) -> Model:
    made = model_for(spec, recording)
    if not made.memoryless:
        raise FitError(
            f"{made.spec} depends on the past motion, and the grid takes laws of which each sample "
            f"stands by itself: use --method rms"
        )
    if made.rigid_body and "load_torque" in made.core.needs:
        raise FitError(
            f"{made.spec} needs the load torque, which {recording.path} does not give: make points "
            f"with `stribeck points --method averaging`, or use --method rms"
        )
    return made


def _ranges(
    made: Model, recording: Recording, grid: Mapping[str, Axis]
) -> tuple[Array, Array, Array]:
    """Bounds of all parameters and points along each nonlinear one, arrays [p], [p], [k]."""
    ranges = Ranges.of(made, recording)
    lower, upper = ranges.lower.copy(), ranges.upper.copy()
    linear = np.array([p.linear for p in made.parameters], dtype=bool)
    searched = np.flatnonzero(~linear & (upper > lower))
    counts = np.ones(lower.size, dtype=np.int64)
    counts[searched] = COUNTS.get(searched.size, 0)
    symbols = {p.symbol: p.name for p in made.parameters}
    for given, axis in grid.items():
        name = symbols.get(given, given)
        nonlinear = [made.names[k] for k in np.flatnonzero(~linear)]
        if name not in nonlinear:
            raise SpecError(
                f"the grid names {given!r}{nearest(name, nonlinear)}, which is no nonlinear "
                f"parameter of {made.spec}; those are {', '.join(nonlinear) or 'none'}"
            )
        if not (np.isfinite([axis.lower, axis.upper]).all() and axis.lower < axis.upper):
            raise SpecError(f"the grid over {given} is empty: from {axis.lower} to {axis.upper}")
        if axis.count < 2:
            raise SpecError(f"the grid over {given} has {axis.count} points: give 2 or more")
        k = made.names.index(name)
        lower[k], upper[k], counts[k] = axis.lower, axis.upper, axis.count
    if not counts.all():
        names = [made.names[k] for k in searched if not counts[k]]
        raise FitError(
            f"{made.spec} has {searched.size} nonlinear parameters, too many for a grid: give the "
            f"range of {', '.join(names)} with --grid, or use --method rms"
        )
    points = math.prod(counts.tolist())
    if points > MOST_POINTS:
        raise FitError(
            f"the grid has {points} points, {MOST_POINTS} at most are searched: give fewer a "
            f"parameter with --grid NAME=FROM:TO:COUNT, its best point is refined anyway"
        )
    return lower, upper, counts[~linear]


class _GridSearch:
    """Regressions over a grid of the nonlinear parameters, in 0..1 from lower to upper."""

    def __init__(self, problem: Problem, lower: Array, upper: Array, counts: Array) -> None:
        self.problem = problem
        self.lower, self.upper, self.counts = lower, upper, counts
        self.linear = np.array([p.linear for p in problem.model.parameters], dtype=bool)
        self.ranges = Ranges(lower[~self.linear], upper[~self.linear])
        self.total = np.inf
        self.values = np.clip(np.zeros(lower.size), lower, upper)
        self.regressions = 0

    def best(self) -> Array:
        """Parameters of least absolute error: of the grid, then of finer grids about its best."""
        spacing = 1.0 / np.maximum(self.counts - 1, 1)
        here = self._search([np.linspace(0.0, 1.0, n) for n in self.counts])
        for _ in range(ROUNDS if self.counts.size else 0):
            here = self._search(
                [
                    np.clip(np.linspace(u - step, u + step, FINER if n > 1 else 1), 0.0, 1.0)
                    for u, step, n in zip(here, spacing, self.counts, strict=True)
                ]
            )
            spacing = spacing * 2.0 / (FINER - 1)
        return self.values

    def _search(self, axes: list[Array]) -> Array:
        """Where the least sum so far lies, after the grid of `axes`; array [k].

        The most promising points are solved first, and those of which least squares shows that
        they cannot be better are passed over: the answer is that of the whole grid.
        """
        points = [np.array(point) for point in itertools.product(*axes)]
        totals = [least_total(*self._regression(u)[:2]) for u in points]
        for k in sorted(range(len(points)), key=lambda k: totals[k][1]):
            if totals[k][0] < self.total:
                self._solve(points[k])
        return self.ranges.share(self.values[~self.linear])

    def _regression(self, u: Array) -> tuple[Array, Array, Array]:
        """Columns [n, linear], target [n] and all parameters [p] at a grid point."""
        values = self.values.copy()
        values[~self.linear] = self.ranges.at(u)
        residual, columns = self.problem.linearise(values, np.flatnonzero(self.linear))
        return columns, residual + columns @ values[self.linear], values

    def _solve(self, u: Array) -> None:
        columns, target, values = self._regression(u)
        solved = least_absolute(columns, target, self.lower[self.linear], self.upper[self.linear])
        self.regressions += 1
        if solved.total < self.total:
            self.total = solved.total
            values[self.linear] = solved.values
            self.values = values


def _held_out(problem: Problem, values: Array, lower: Array, upper: Array) -> Array:
    """Prediction of every row by the regression that has not seen its block, array [n].

    Each is one step of least absolute error from the solution in all parameters, for which the law
    is linear: leaving one block out moves them little.
    """
    recording = problem.recording
    prediction = problem.predict(values)
    residual, jacobian = problem.linearise(values)
    for block in np.unique(recording.block[problem.rows]):
        kept = recording.block[problem.rows] != block
        step = least_absolute(jacobian[kept], residual[kept], lower - values, upper - values)
        here = recording.block == block
        prediction[here] = problem.predict(values + step.values)[here]
    return prediction


def _as_fit(made: Model, whole: Problem, search: _GridSearch) -> Fit:
    recording, used = whole.recording, search.problem
    held_out = _held_out(used, made.values, search.lower, search.upper)
    residual = recording.torque - held_out
    note = (
        f"least absolute error over a grid of {math.prod(search.counts.tolist())} points, then "
        f"refined: mean {search.total / used.rows.size:.4g} {recording.torque_unit} over "
        f"{used.rows.size} of {whole.rows.size} rows"
    )
    enough = np.unique(recording.block[used.rows]).size > 1
    fitted = evaluate(made, recording)
    return replace(
        fitted,
        estimates=_estimates(made, used, search.lower, search.upper),
        held_out=held_out,
        rmse_held_out=rms(residual[recording.moving]) if enough else None,
        relative_residual=relative_residual(recording, residual) if enough else None,
        starts=1,
        outcome="searched the whole grid",
        evaluations=search.regressions,
        notes=(note, *fitted.notes),
    )


def _estimates(made: Model, problem: Problem, lower: Array, upper: Array) -> dict[str, Estimate]:
    residual, jacobian = problem.linearise(made.values)
    at_bound = reached_bounds(made.values, lower, upper)
    shown = seen(jacobian, np.ones(lower.size, dtype=bool))
    errors = standard_errors(jacobian, residual, shown & ~at_bound)
    return estimates(made, errors, at_bound, shown)
