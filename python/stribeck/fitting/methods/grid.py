"""Linear regression on a grid of the nonlinear parameters, with least absolute error.

Bittencourt et al. 2010, eqs 5-6: a friction law tau = f(v, theta2) theta1 is linear in theta1 for
given theta2. Each point of a grid over theta2 is a regression; the result is the one with the least
sum of absolute errors. It is robust to outliers, unlike least squares.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, SpecError, nearest, option
from stribeck.fitting.evaluate import evaluate
from stribeck.fitting.methods.estimates import estimates, reached_bounds
from stribeck.fitting.methods.least_absolute import least_absolute, least_total, standard_errors
from stribeck.fitting.methods.ranges import Ranges
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import seen
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.figures import relative_residual, rms
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import model_for
from stribeck.identify.stated.choices import refuse_statements
from stribeck.models.model import Model
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]

#: Most samples of the regressions, evenly spaced. The time of a linear programme grows faster than
#: its size, and steady-state points are few.
MOST_ROWS = 500
#: Most points of a grid; a larger one would take minutes to hours.
MOST_POINTS = 20_000
#: Points per nonlinear parameter, by the number of these parameters.
COUNTS = {1: 120, 2: 40, 3: 10, 4: 6}
#: Number of refined grids about the best point, and their points per parameter.
ROUNDS, FINER = 8, 5


@dataclass(frozen=True)
class Axis:
    """One parameter of a grid: from `lower` to `upper`, uniform in its logarithm if positive."""

    lower: float
    upper: float
    count: int


def grid_fit(
    spec: str | Model, recording: Recording, *, grid: Mapping[str, Axis] | None = None
) -> Fit:
    """Identify a static law by linear regression on a grid, with least absolute error.

    Parameters
    ----------
    spec : str or Model
        A law without a state, ``"m0"`` or ``"bittencourt_a"``; a model's values are not used.
    recording : Recording
        Preferably steady-state points. At most 500 evenly spaced moving samples are used for the
        sum of absolute errors; RMSE and held-out RMSE are over all moving samples.
    grid : mapping of parameter name (or symbol) to Axis, optional
        Ranges and counts; default: those of random starts, with 120, 40, 10 or 6 points per
        parameter for 1 to 4 parameters. The grid is refined about its best point, within the range.

    Returns
    -------
    Fit
        Standard errors are those of median regression (Koenker and Bassett 1978).

    Raises
    ------
    SpecError
        A grid over a parameter that the law does not have, or that is linear.
    FitError
        A law with a state; too many nonlinear parameters; too few samples; a missing channel.

    Examples
    --------
    >>> speeds = Axis(1.0, 50.0, 60)
    >>> points = sb.read("points.csv")  # doctest: +SKIP
    >>> grid = {"stribeck_velocity": speeds}
    >>> grid_fit("bittencourt_a", points, grid=grid)  # doctest: +SKIP
    """
    refuse_weights("the method 'grid'", recording)
    began = time.perf_counter()
    made = _static_model(spec, recording)
    refuse_statements(made, "the method 'grid'")
    if made.stated.algorithm is not None:
        raise SpecError("the method 'grid' does not search: omit " + option("algorithm"))
    rows = np.flatnonzero(recording.moving)
    if rows.size < len(made.names) + 2:
        raise FitError(
            f"{recording.path} has {rows.size} moving samples, {made.spec} needs at least "
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
            f"{made.spec} depends on the past motion, and a grid needs a law without memory: use "
            f"{option('method', 'rms')}"
        )
    if made.rigid_body and "load_torque" in made.core.needs:
        raise FitError(
            f"{made.spec} needs the load torque, which {recording.path} does not give: make "
            f"steady-state points by averaging, or use {option('method', 'rms')}"
        )
    return made


def _ranges(
    made: Model, recording: Recording, grid: Mapping[str, Axis]
) -> tuple[Array, Array, Array]:
    """Bounds of all parameters, points per nonlinear parameter: arrays [p], [p], [k]."""
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
                f"the grid names {given!r}{nearest(name, nonlinear)}, which is not a nonlinear "
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
            f"range of {', '.join(names)} with {option('grid')}, or use {option('method', 'rms')}"
        )
    points = math.prod(counts.tolist())
    if points > MOST_POINTS:
        raise FitError(
            f"the grid has {points} points, at most {MOST_POINTS} are searched: give fewer per "
            f"parameter with {option('grid', 'NAME=FROM:TO:COUNT')}; the best one is refined"
        )
    return lower, upper, counts[~linear]


class _GridSearch:
    """Regressions on a grid of the nonlinear parameters, scaled to 0..1 between bounds."""

    def __init__(self, problem: Problem, lower: Array, upper: Array, counts: Array) -> None:
        self.problem = problem
        self.lower, self.upper, self.counts = lower, upper, counts
        self.linear = np.array([p.linear for p in problem.model.parameters], dtype=bool)
        self.ranges = Ranges(lower[~self.linear], upper[~self.linear])
        self.total = np.inf
        self.values = np.clip(np.zeros(lower.size), lower, upper)
        self.regressions = 0

    def best(self) -> Array:
        """Parameters with the least absolute error on the grid and its refinements, array [p]."""
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
        """The point with the least sum so far, after the grid of `axes`, array [k].

        The most promising points are solved first. Points that a bound from least squares rules
        out are skipped, which does not change the result.
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
    """Prediction of every sample by a regression without its block, array [n].

    Each regression is one step of least absolute error in all parameters of the linearised law,
    from the solution: leaving one block out changes it little.
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
        f"{used.rows.size} of {whole.rows.size} samples"
    )
    enough = np.unique(recording.block[used.rows]).size > 1
    fitted = evaluate(made, recording)
    return replace(
        fitted,
        estimates=_estimates(made, used, search.lower, search.upper),
        held_out=held_out,
        rmse_held_out=rms(residual[recording.moving]) if enough else None,
        relative_residual=relative_residual(recording, residual) if enough else None,
        rank=None,  # The criteria are of least squares.
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
