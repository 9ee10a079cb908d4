"""Separable least squares by Levenberg and Marquardt's method.

Golub and Pereyra (1973), in Kaufman's form (1975): steps are taken in the nonlinear parameters
alone, and at each point the linear ones are solved for. What is damped, and what is compared
before and after, is therefore the error that the linear parameters leave. Damping follows Nielsen
(1999). Bounds hold throughout; a parameter whose bounds are equal is held.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.triangle import Triangle
from stribeck.model import Model

Array = NDArray[np.float64]

MOST_ROUNDS = 50
#: A fall of the sum of squares by less than this share, foreseen by the undamped step, ends it.
TOLERANCE = 1e-18
#: First damping where the search starts far away, in squared lengths of the columns.
CAUTIOUS = 1e-2
#: Damping from which a step that is taken back goes on.
LEAST_RETREAT = 5e-4
#: A damping beyond which no step can be told from standing still.
MOST_DAMPING = 1e20
#: A linear step that lowers the sum of squares by more than this share bends the columns of the
#: nonlinear parameters: they are computed anew.
BENT = 1e-3


class LeastSquares(Protocol):
    """A model against measured torque: rows in memory, or a data set that is read in passes."""

    @property
    def model(self) -> Model:
        """The model whose parameters are sought."""

    @property
    def torque_norm(self) -> float:
        """Norm of the measured torque; asked for after the first `triangle`."""

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """The problem linearised at `values`; None where the model is not finite there.

        Parameters
        ----------
        values : array [p]
        wanted, slope : arrays [k]
            The parameters to differentiate by, and by what their columns are multiplied.
        """


@dataclass
class Search:
    """Where one search ended."""

    values: Array
    square: float
    converged: bool
    outcome: str


@dataclass(frozen=True)
class _Point:
    """Values at which the linear parameters are the best, and the problem linearised there."""

    values: Array
    triangle: Triangle

    @property
    def square(self) -> float:
        return self.triangle.square


class _Separable:
    """A problem with its free parameters in order: the linear ones first.

    Parameters
    ----------
    logarithmic : bool array [p]
        Nonlinear parameters whose logarithm is stepped in; they keep their sign.
    """

    def __init__(
        self, problem: LeastSquares, lower: Array, upper: Array, logarithmic: NDArray[np.bool_]
    ) -> None:
        self.problem, self.lower, self.upper = problem, lower, upper
        linear = np.array([p.linear for p in problem.model.parameters], dtype=bool)
        free = lower < upper
        self.count = int((linear & free).sum())
        self.order = np.concatenate([np.flatnonzero(linear & free), np.flatnonzero(~linear & free)])
        self.logarithmic = (logarithmic & ~linear)[self.order]
        self.evaluations = 0

    def at(self, values: Array) -> _Point | None:
        """The point with the nonlinear parameters of `values`; None where it is not finite."""
        point = self._linearised(values)
        for _ in range(2):
            if point is None or self.count == 0:
                return point
            solved, fall = self._with_linear_solved(point)
            if fall <= BENT * point.square:
                return solved
            point = self._linearised(solved.values)
        return point

    def _linearised(self, values: Array) -> _Point | None:
        if not np.all(np.isfinite(values)):
            return None
        self.evaluations += 1
        slope = np.where(self.logarithmic, values[self.order], 1.0)
        with np.errstate(all="ignore"):
            triangle = self.problem.triangle(values, self.order, slope)
        return None if triangle is None else _Point(values, triangle)

    def _with_linear_solved(self, point: _Point) -> tuple[_Point, float]:
        """Move the linear parameters to their best; the torque is linear in them, so R stays."""
        whole, n = point.triangle, self.count
        inner = Triangle(whole.factor[:n, :n], whole.right[:n], 0.0)
        lower, upper = self._room(point.values)
        step = np.zeros(whole.right.size)
        step[:n] = inner.solve(lower[:n], upper[:n])
        right = whole.right - whole.factor @ step
        moved = _Point(self.moved(point.values, step), Triangle(whole.factor, right, whole.rest))
        return moved, point.square - moved.square

    def moved(self, values: Array, step: Array) -> Array:
        """`values` after a step of the free parameters, within bounds."""
        at = values[self.order]
        with np.errstate(over="ignore", invalid="ignore"):
            gone = np.where(self.logarithmic, at * np.exp(step), at + step)
        after = values.copy()
        after[self.order] = np.clip(gone, self.lower[self.order], self.upper[self.order])
        return after

    def _room(self, values: Array) -> tuple[Array, Array]:
        """How far each free parameter may still go, down and up."""
        at, low, high = values[self.order], self.lower[self.order], self.upper[self.order]
        with np.errstate(divide="ignore", invalid="ignore"):
            down = np.where(self.logarithmic, np.log(np.maximum(low / at, 0.0)), low - at)
            up = np.where(self.logarithmic, np.log(np.maximum(high / at, 0.0)), high - at)
        return np.minimum(down, up), np.maximum(down, up)

    def step(self, point: _Point, damping: Array | None) -> Array:
        """The best step of the free parameters, damped or not."""
        return point.triangle.solve(*self._room(point.values), damping)

    def lengths(self, point: _Point) -> Array:
        """Lengths of the columns of the nonlinear parameters, less what linear ones explain."""
        outside = point.triangle.factor[self.count :, self.count :]
        lengths = np.zeros(self.order.size)
        lengths[self.count :] = np.sqrt(np.einsum("ij,ij->j", outside, outside))
        return lengths


def minimise(
    problem: LeastSquares,
    values: Array,
    lower: Array,
    upper: Array,
    *,
    tolerance: float = TOLERANCE,
    most: int = MOST_ROUNDS,
    damping: float = 0.0,
    logarithmic: NDArray[np.bool_] | None = None,
    landed: Callable[[Array, float], bool] | None = None,
) -> tuple[Search, int]:
    """Bring the sum of squares down from `values` to the minimum they lead to.

    Parameters
    ----------
    values, lower, upper : arrays [p]
        Start and bounds; infinite bounds are none, equal ones hold a parameter.
    tolerance : float
        The search ends when the undamped step foresees a smaller relative fall.
    most : int
        Most steps, those that are taken back included.
    damping : float
        First damping: 0 from a point near the minimum, `CAUTIOUS` from anywhere else.
    logarithmic : bool array [p]
        Nonlinear parameters whose logarithm is stepped in.
    landed : function of values [p] and their sum of squares
        Ends the search where it says that another one has been there.

    Returns
    -------
    Search, evaluations
        The sum of squares is infinite where the model is not finite at `values`.
    """
    if logarithmic is None:
        logarithmic = np.zeros(values.size, dtype=bool)
    search = _Separable(problem, lower, upper, logarithmic)
    start = np.clip(values, lower, upper)
    with np.errstate(all="ignore"):
        # Steps that leave the range of numbers are taken back.
        found = _descend(search, start, tolerance, most, damping, landed)
        return found, search.evaluations


def rounding(problem: LeastSquares) -> float:
    """Norm of the rounding of the torque: what is left where a model fits exactly."""
    return float(np.finfo(float).eps) * problem.torque_norm


def _descend(
    search: _Separable,
    start: Array,
    tolerance: float,
    most: int,
    damping: float,
    landed: Callable[[Array, float], bool] | None,
) -> Search:
    """Damped steps from `start` until the next one would change nothing."""
    point = search.at(start)
    if point is None:
        return Search(start, np.inf, False, "the model is not finite at the start")
    # Below this a fall cannot be told from the rounding of the torque itself.
    noise = 4.0 * rounding(search.problem)
    scale = np.zeros(search.order.size)
    growth = 2.0
    outcome = "stopped at the largest number of steps"
    for _ in range(most):
        full = search.step(point, None)
        foreseen = point.triangle.fall(full)
        if foreseen <= max(tolerance * point.square, noise**2):
            outcome = "converged"
            break
        scale = np.maximum(scale, search.lengths(point))
        step = full if damping == 0.0 else search.step(point, np.sqrt(damping) * scale)
        foreseen = point.triangle.fall(step)
        tried = search.at(search.moved(point.values, step))
        fall = -np.inf if tried is None else point.square - tried.square
        if tried is not None and fall >= -noise * np.sqrt(point.square):
            share = np.clip(fall / foreseen, 0.0, 1.0) if foreseen > 0.0 else 0.0
            point = tried
            damping *= max(0.1, 1.0 - (2.0 * share - 1.0) ** 3)
            damping = 0.0 if damping < 1e-12 else damping
            growth = 2.0
            if landed is not None and landed(point.values, point.square):
                outcome = "converged (where another search did)"
                break
        else:
            damping = max(damping, LEAST_RETREAT) * growth
            growth *= 2.0
            if damping > MOST_DAMPING:
                outcome = "converged (to rounding)"
                break
    converged = outcome.startswith("converged")
    return Search(point.values, point.square, converged, outcome)
