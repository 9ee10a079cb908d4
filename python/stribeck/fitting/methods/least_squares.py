"""Least squares of some parameters of a law while the others are held."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.methods.ranges import Ranges
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Sums of squares that differ by less are equal.
TIE = 1.0 + 1e-6


class BoundedLeastSquares:
    """Least squares of some parameters while the others are held, from several starts.

    Levenberg and Marquardt's method in its trust-region form, which respects bounds.

    Attributes
    ----------
    start
        Values of the first start, array [p]: those of the model where known, else the catalog's.
    evaluations
        Number of evaluations of the residuals so far.
    """

    def __init__(self, made: Model, recording: Recording, starts: int, seed: int) -> None:
        self.ranges = Ranges.of(made, recording)
        self.lower, self.upper = self.ranges.lower, self.ranges.upper
        _, _, usual = bounds(made, recording)
        known = np.where(np.isfinite(made.values), made.values, usual)
        self.start = np.clip(known, self.lower, self.upper)
        self.nonlinear = np.array([not p.linear for p in made.parameters])
        self.starts = max(starts, 1)
        self.evaluations = 0
        self.random = np.random.default_rng(seed)

    def solve(self, problem: Problem, values: Array, free: Indices) -> Array:
        """`values` [p] with the parameters `free` at their least sum of squares.

        Raises
        ------
        FitError
            Fewer points than parameters; a law that is finite at none of the starts.
        """
        if problem.rows.size < free.size + 2:
            raise FitError(
                f"{problem.recording.path} has {problem.rows.size} moving points for "
                f"{free.size} parameters: record more speeds"
            )
        found = [self._from(problem, values, free, k) for k in range(self.starts)]
        least = min(square for square, _ in found)
        if not np.isfinite(least):
            raise FitError(f"{problem.model.spec} is not finite on {problem.recording.path}")
        # Of equal ones the first, from the usual start: in some laws a sign is not identifiable.
        return next(reached for square, reached in found if square <= TIE * least)

    def _from(self, problem: Problem, values: Array, free: Indices, k: int) -> tuple[float, Array]:
        """Sum of squares and values reached from the k-th start; the first is the usual one."""
        values = values.copy()
        drawn = self.random.uniform(size=values.size)
        if k > 0:
            here = free[self.nonlinear[free]]
            values[here] = self.ranges.at(drawn)[here]

        def residual(x: Array) -> Array:
            values[free] = x
            return problem.linearise(values, free)[0]

        def slope(x: Array) -> Array:
            values[free] = x
            return -problem.linearise(values, free)[1]

        if not np.all(np.isfinite(residual(values[free]))):
            return np.inf, values
        found = scipy.optimize.least_squares(
            residual,
            values[free],
            slope,
            x_scale="jac",
            bounds=(self.lower[free], self.upper[free]),
        )
        values[free] = found.x
        self.evaluations += int(found.nfev)
        return float(found.cost), values
