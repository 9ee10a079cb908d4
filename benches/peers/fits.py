"""The least-squares fit as a skilled user writes it with SciPy, or has it from lmfit."""

from __future__ import annotations

from collections.abc import Callable

import lmfit
import numpy as np
from scipy.optimize import minimize


class Slsqp:
    """Bounded least squares from random starts in the unit cube, by an analytic gradient."""

    def __init__(
        self,
        gradient: Callable,
        velocity: np.ndarray,
        torque: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        starts: int,
    ) -> None:
        self.gradient, self.velocity, self.torque = gradient, velocity, torque
        self.lower, self.upper = lower, upper
        self.starts = np.random.default_rng(0).random((starts, lower.size))
        self.errors: list[float] = []

    def _cost(self, unit: np.ndarray) -> tuple[float, np.ndarray]:
        width = self.upper - self.lower
        torque, slopes = self.gradient(self.velocity, tuple(self.lower + unit * width))
        residual = torque - self.torque
        square = residual @ residual / residual.size
        return square, 2.0 * width * (residual @ slopes) / residual.size

    def run(self) -> float:
        """The least RMS error of all starts (T)."""
        cube = [(0.0, 1.0)] * self.lower.size
        options = {"maxiter": 300, "ftol": 1e-12}
        self.errors = [
            float(
                np.sqrt(
                    minimize(
                        self._cost, start, jac=True, method="SLSQP", bounds=cube, options=options
                    ).fun
                )
            )
            for start in self.starts
        ]
        return min(self.errors)

    def at_optimum(self) -> int:
        """How many starts end within 0.1 % of the best error."""
        return sum(error <= 1.001 * min(self.errors) for error in self.errors)


class Levenberg:
    """Bounded least squares by lmfit from one start, by an analytic gradient; standard errors."""

    def __init__(
        self,
        gradient: Callable,
        velocity: np.ndarray,
        torque: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        start: np.ndarray,
    ) -> None:
        self.gradient, self.velocity, self.torque = gradient, velocity, torque
        self.parameters = lmfit.Parameters()
        for k, (low, high, value) in enumerate(zip(lower, upper, start, strict=True)):
            self.parameters.add(f"a{k + 1}", value=value, min=low, max=high)

    def _linearised(self, parameters: lmfit.Parameters) -> tuple[np.ndarray, np.ndarray]:
        values = tuple(parameter.value for parameter in parameters.values())
        return self.gradient(self.velocity, values)

    def run(self) -> float:
        """The RMS error (T)."""
        found = lmfit.minimize(
            lambda parameters: self._linearised(parameters)[0] - self.torque,
            self.parameters,
            method="leastsq",
            Dfun=lambda parameters: self._linearised(parameters)[1],
        )
        return float(np.sqrt(np.mean(found.residual**2)))
