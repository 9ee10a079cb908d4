"""Least squares under conditions: Gauss and Newton's steps, each solved by nlopt's SLSQP.

The residual is linearised, the conditions are not: a step minimises the squared linearised
residual under the conditions themselves, so every point after the first step holds them. Only p
columns of a triangular factor enter it, whatever the number of rows.
"""

from __future__ import annotations

from dataclasses import dataclass

import nlopt
import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.identify.problem import Problem
from stribeck.identify.reduced import Search
from stribeck.identify.triangle import Triangle
from stribeck.passivity.conditions import Conditions

Array = NDArray[np.float64]

#: Most steps, those that are taken back included.
MOST_STEPS = 25
#: The search ends when its next step foresees a smaller relative fall of the sum of squares.
SETTLED = 1e-7
#: Damping of the step after one that is taken back, in squared lengths of the columns.
FIRST_DAMPING = 1e-3
#: A damping beyond which a step is too short to bring anything.
MOST_DAMPING = 1e8
#: From a point that misses a condition a step may miss its foreseen square by this factor.
ASTRAY = 1.5
#: Most evaluations of one step; they cost nothing but the conditions.
MOST_EVALUATIONS = 400
#: Conditions are aimed at with this much to spare, so that rounding does not miss them.
AIM = 1e-10


def minimise_under(
    problem: Problem, values: Array, lower: Array, upper: Array, conditions: Conditions
) -> tuple[Search, int]:
    """The least sum of squares near `values` at which the conditions hold.

    Returns
    -------
    Search, evaluations
        The sum of squares is infinite where no values were found that hold the conditions.
    """
    free = np.flatnonzero(lower < upper)
    point = _linearised(problem, values, free)
    if point is None:
        return Search(values, np.inf, False, "the model is not finite at the start"), 1
    held, damping, evaluations = conditions.hold(values), 0.0, 1
    outcome = "stopped at the largest number of steps"
    for _ in range(MOST_STEPS):
        refit = step_under(_damped(point, damping), values, free, lower, upper, conditions)
        if refit is None:
            return Search(values, np.inf, False, "no values hold the conditions"), evaluations
        step = (refit - values)[free]
        if held and point.fall(step) <= SETTLED * point.square:
            return Search(values, point.square, True, "converged"), evaluations
        foreseen = point.square - point.fall(step)
        limit = point.square if held else ASTRAY * foreseen
        tried = _linearised(problem, refit, free)
        evaluations += 1
        # A step that only short ones would spare is taken all the same: the conditions come first.
        if tried is not None and (tried.square <= limit or (not held and damping > 1.0)):
            values, point, held, damping = refit, tried, True, 0.1 * damping
            damping = damping if damping > FIRST_DAMPING else 0.0
        else:
            damping = max(10.0 * damping, FIRST_DAMPING)
            if damping > MOST_DAMPING:
                outcome = "converged (to rounding)"
                break
    square = point.square if held else np.inf
    return Search(values, square, outcome.startswith("converged"), outcome), evaluations


def step_under(
    triangle: Triangle,
    values: Array,
    free: NDArray[np.intp],
    lower: Array,
    upper: Array,
    conditions: Conditions,
) -> Array | None:
    """The values [p] with the least linearised square that hold the conditions; None: none found.

    Parameters
    ----------
    triangle
        Of the columns of the `free` parameters, at `values`.
    """
    plain = values.copy()
    plain[free] += triangle.solve(lower[free] - values[free], upper[free] - values[free])
    plain = np.clip(plain, lower, upper)
    if conditions.hold(plain):
        return plain
    step = _Step(triangle, values, free, lower, upper, conditions)
    found = step.least(np.zeros(free.size))
    if found is None:
        inside = step.inside()
        found = None if inside is None else step.least(inside)
        found = inside if found is None else found
    return None if found is None else step.values(found)


@dataclass(frozen=True)
class Conditioned:
    """Refits within bounds [p] and under conditions."""

    lower: Array
    upper: Array
    conditions: Conditions

    def step(self, values: Array, triangle: Triangle) -> Array:
        """One step of the free parameters; none where no values hold the conditions."""
        free = np.flatnonzero(self.lower < self.upper)
        refit = step_under(triangle, values, free, self.lower, self.upper, self.conditions)
        return values.copy() if refit is None else refit

    def search(self, problem: Problem, values: Array) -> Array:
        """As many steps as it takes."""
        found, _ = minimise_under(problem, values, self.lower, self.upper, self.conditions)
        return found.values


def _linearised(problem: Problem, values: Array, free: NDArray[np.intp]) -> Triangle | None:
    try:
        with np.errstate(all="ignore"):
            residual, jacobian = problem.linearise(values, free)
            triangle = Triangle.of(jacobian, residual)
    except _core.ModelError:
        return None
    return triangle if np.all(np.isfinite(triangle.factor)) else None


def _damped(triangle: Triangle, damping: float) -> Triangle:
    """The triangle with Levenberg and Marquardt's rows."""
    if damping == 0.0:
        return triangle
    lengths = np.sqrt(damping * np.einsum("ij,ij->j", triangle.factor, triangle.factor))
    return Triangle.of(
        np.concatenate([triangle.factor, np.diag(lengths)]),
        np.concatenate([triangle.right, np.zeros(lengths.size)]),
    )


class _Step:
    """A step in coordinates in which one unit of each moves the torque by the residual's size."""

    def __init__(
        self,
        triangle: Triangle,
        values: Array,
        free: NDArray[np.intp],
        lower: Array,
        upper: Array,
        conditions: Conditions,
    ) -> None:
        size = np.sqrt(triangle.square) or 1.0
        lengths = np.sqrt(np.einsum("ij,ij->j", triangle.factor, triangle.factor))
        own = np.abs(values[free]) + np.where(values[free] == 0.0, 1.0, 0.0)
        # A parameter that the data does not show moves by its own size.
        self.unit = np.minimum(size / np.maximum(lengths, size * 1e-12), own)
        self.factor = triangle.factor * self.unit / size
        self.right = triangle.right / size
        self.start, self.free, self.conditions = values, free, conditions
        self.lower = (lower[free] - values[free]) / self.unit
        self.upper = (upper[free] - values[free]) / self.unit
        self.bounds = lower, upper
        self._last: tuple[bytes, tuple[Array, Array]] | None = None

    def values(self, y: Array) -> Array:
        """The parameters [p] after a step."""
        moved = self.start.copy()
        moved[self.free] += self.unit * y
        return np.clip(moved, *self.bounds)

    def square(self, y: Array) -> tuple[float, Array]:
        """Of the linearised residual, and its slope."""
        left = self.factor @ y - self.right
        return float(left @ left), 2.0 * (self.factor.T @ left)

    def shares(self, y: Array) -> tuple[Array, Array]:
        """Of the conditions [n], and their slopes; where the friction means nothing, far off."""
        # The optimiser asks for the objective and the conditions at each point in turn.
        key = y.tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, self._shares(y)
        return self._last[1]

    def _shares(self, y: Array) -> tuple[Array, Array]:
        try:
            with np.errstate(all="ignore"):
                shares, slopes = self.conditions.shares(self.values(y))
        except _core.ModelError:
            shares = np.full(len(self.conditions.requirements), -1.0)
            slopes = np.zeros((shares.size, self.start.size))
        shares = np.nan_to_num(shares, nan=-1.0, posinf=1e6, neginf=-1e6)
        return shares, np.nan_to_num(slopes[:, self.free] * self.unit, posinf=1e6, neginf=-1e6)

    def least(self, start: Array) -> Array | None:
        """The least square under the conditions from `start`; None where none was found."""
        best: tuple[float, Array] | None = None

        def objective(y: Array, gradient: Array) -> float:
            nonlocal best
            square, slope = self.square(y)
            if gradient.size:
                gradient[:] = slope
            if best is None or square < best[0]:
                held = np.all(self.shares(y)[0] >= 0.0)
                best = (square, y.copy()) if held else best
            return square

        def short(result: Array, y: Array, gradient: Array) -> None:
            shares, slopes = self.shares(y)
            result[:] = AIM - shares
            if gradient.size:
                gradient[:] = -slopes

        optimizer = nlopt.opt(nlopt.LD_SLSQP, start.size)
        optimizer.set_lower_bounds(self.lower)
        optimizer.set_upper_bounds(self.upper)
        optimizer.set_min_objective(objective)
        optimizer.add_inequality_mconstraint(short, np.zeros(len(self.conditions.requirements)))
        _run(optimizer, start)
        return None if best is None else best[1]

    def inside(self) -> Array | None:
        """A step after which the conditions hold, from one after which they may not.

        The least share is raised as a variable of its own, until all conditions hold.
        """
        count = self.free.size
        room = 1e-3 + self.conditions.reserve
        found: Array | None = None

        def objective(x: Array, gradient: Array) -> float:
            square, slope = self.square(x[:count])
            if gradient.size:
                gradient[:count], gradient[count] = 1e-6 * slope, -1.0
            return 1e-6 * square - float(x[count])

        def short(result: Array, x: Array, gradient: Array) -> None:
            nonlocal found
            shares, slopes = self.shares(x[:count])
            if np.all(shares >= 0.0):
                found = x[:count].copy()
            result[:] = x[count] - shares
            if gradient.size:
                gradient[:, :count], gradient[:, count] = -slopes, 1.0

        start = np.append(np.zeros(count), self.shares(np.zeros(count))[0].min())
        optimizer = nlopt.opt(nlopt.LD_SLSQP, count + 1)
        optimizer.set_lower_bounds(np.append(self.lower, -np.inf))
        optimizer.set_upper_bounds(np.append(self.upper, room))
        optimizer.set_min_objective(objective)
        optimizer.add_inequality_mconstraint(short, np.zeros(len(self.conditions.requirements)))
        _run(optimizer, start)
        return found


def _run(optimizer: nlopt.opt, start: Array) -> None:
    """Optimise; what it met on the way is kept by its functions, whatever it ends with."""
    optimizer.set_ftol_rel(1e-13)
    optimizer.set_xtol_abs(1e-12)
    optimizer.set_maxeval(MOST_EVALUATIONS)
    try:
        optimizer.optimize(start)
    except (nlopt.RoundoffLimited, nlopt.runtime_error):
        # Raised at an optimum too, when no further fall can be resolved.
        return
