"""Variable projection: linear parameters are solved for, nlopt searches the others.

Golub and Pereyra (1973): for given nonlinear parameters the best linear ones follow from a
linear (here bounded) least-squares problem; by the envelope theorem the gradient of what is
left is the partial derivative at that solution.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import nlopt
import numpy as np
from numpy.typing import NDArray

from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.identify.problem import Problem

Array = NDArray[np.float64]

#: nlopt's result codes in plain words.
OUTCOMES = {
    1: "converged",
    2: "reached the stop value",
    3: "converged (error no longer falls)",
    4: "converged (parameters no longer move)",
    5: "stopped at the largest number of evaluations",
    6: "stopped at the time limit",
}


@dataclass
class Search:
    """Where one search ended."""

    values: Array
    square: float
    converged: bool
    outcome: str


@dataclass
class ReducedProblem:
    """The sum of squared residuals as a function of the nonlinear parameters alone."""

    problem: Problem
    lower: Array
    upper: Array
    evaluations: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        parameters = self.problem.model.parameters
        linear = np.array([p.linear for p in parameters], dtype=bool)
        # A parameter whose bounds are equal is held.
        free = self.lower < self.upper
        self.linear, self.nonlinear = linear & free, ~linear & free
        # Speeds, exponents and stiffnesses span decades: search their logarithm.
        self._log = (self.lower > 0)[self.nonlinear]

    def encode(self, values: Array) -> Array:
        """Search coordinates in 0..1 of the nonlinear parameters."""
        low, high = self.lower[self.nonlinear], self.upper[self.nonlinear]
        x = np.clip(values[self.nonlinear], low, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = np.log(x / low) / np.log(high / low)
        return np.where(self._log, logarithmic, (x - low) / (high - low))

    def decode(self, u: Array) -> Array:
        """Nonlinear parameters of search coordinates."""
        low, high = self.lower[self.nonlinear], self.upper[self.nonlinear]
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = low * (high / low) ** u
        x = np.where(self._log, logarithmic, low + u * (high - low))
        return np.clip(x, low, high)

    def drawn(self, start: Array, random: np.random.Generator) -> Array:
        """`start` [p] with nonlinear parameters at random, even over the search coordinates."""
        values = start.copy()
        values[self.nonlinear] = self.decode(random.uniform(size=int(self.nonlinear.sum())))
        return values

    def _slope(self, values: Array) -> Array:
        """Derivative of the nonlinear parameters with respect to the search coordinates."""
        low, high = self.lower[self.nonlinear], self.upper[self.nonlinear]
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithmic = values[self.nonlinear] * np.log(high / low)
        return np.where(self._log, logarithmic, high - low)

    def complete(self, values: Array) -> Array:
        """The best linear parameters for the nonlinear ones in `values`."""
        values = values.copy()
        if not self.linear.any():
            return values
        residual, columns = self.problem.linearise(values, np.flatnonzero(self.linear))
        without = residual + columns @ values[self.linear]
        matrix, vector = NormalEquations.of(columns, without).total()
        values[self.linear] = solve_bounded(
            matrix, vector, self.lower[self.linear], self.upper[self.linear]
        )
        self.evaluations += 1
        return values

    def square_and_slope(self, values: Array) -> tuple[float, Array]:
        """Sum of squares, and its derivative with respect to the search coordinates."""
        residual, jacobian = self.problem.linearise(values, np.flatnonzero(self.nonlinear))
        self.evaluations += 1
        steep = -2.0 * (jacobian.T @ residual)
        return float(residual @ residual), steep * self._slope(values)

    def search(self, start: Array, most: int, tolerance: float) -> Search:
        """Search from `start` (all parameters) with nlopt's SLSQP; keep the best point met."""
        first = self.complete(start)
        if not self.nonlinear.any():
            residual, _ = self.problem.linearise(first)
            return Search(first, float(residual @ residual), True, "solved directly")
        best = Search(first, np.inf, False, "not started")
        scale = 1.0

        def objective(u: Array, gradient: Array) -> float:
            nonlocal best, scale
            values = best.values.copy()
            # nlopt's u is a view of its own memory, so decode (which copies) before keeping it.
            values[self.nonlinear] = self.decode(u)
            values = self.complete(values)
            square, slope = self.square_and_slope(values)
            if not np.isfinite(square):
                # nlopt takes NaN for success: give it a wall instead.
                gradient[:] = 0.0
                return 1e30
            if best.square == np.inf:
                scale = max(square, np.finfo(float).tiny)
            if square < best.square:
                best = Search(values, square, False, "")
            if gradient.size:
                gradient[:] = slope / scale
            return square / scale

        count = int(self.nonlinear.sum())
        optimizer = nlopt.opt(nlopt.LD_SLSQP, count)
        optimizer.set_lower_bounds(np.zeros(count))
        optimizer.set_upper_bounds(np.ones(count))
        optimizer.set_min_objective(objective)
        optimizer.set_ftol_rel(tolerance)
        optimizer.set_xtol_abs(1e-9)
        optimizer.set_maxeval(most)
        try:
            optimizer.optimize(np.clip(self.encode(first), 0.0, 1.0))
            code = int(optimizer.last_optimize_result())
            best.converged = code in (1, 3, 4)
            best.outcome = OUTCOMES.get(code, f"stopped by the optimizer (code {code})")
        except nlopt.RoundoffLimited:
            # Raised at an optimum too, when no further fall can be resolved.
            best.converged, best.outcome = True, "converged (to rounding)"
        except nlopt.runtime_error as error:
            best.outcome = f"stopped by the optimizer ({error})"
        return best
