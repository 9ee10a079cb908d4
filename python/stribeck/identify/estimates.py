"""Identified parameters with their standard errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.confounded import partners, reason
from stribeck.identify.covariance import (
    batches,
    correlation_length,
    independent,
    sandwich,
    seen,
)
from stribeck.identify.problem import Problem
from stribeck.models.model import Model

Array = NDArray[np.float64]

#: What standard errors assume about the residual.
#:
#: ``"robust"``: it may be autocorrelated and heteroscedastic, as the residual of any sampled motion
#: is: the error of a friction model is smooth in time.
#: ``"independent"``: errors are independent and of equal variance, as those of separately measured
#: points. This is the textbook's ``s^2 (J'J)^-1`` with n - p degrees of freedom; on a sampled
#: motion it is far too optimistic.
Errors = Literal["robust", "independent"]
#: A parameter is at its bound within this share of its range.
AT_BOUND = 1e-6
#: A parameter is identifiable if the others leave at least this share of its effect: more than
#: systematic errors of a recording, or more than rounding.
APART: dict[Errors, float] = {"robust": 1e-4, "independent": 1e-8}


@dataclass(frozen=True)
class Estimate:
    """One identified parameter: value, standard error and 95 % interval in `unit`.

    A parameter that was `held` was not identified and has no standard error. `why` states for a
    parameter that is not `identifiable` which others have the same effect.
    """

    name: str
    symbol: str
    value: float
    unit: str
    stderr: float | None
    ci95: tuple[float, float] | None
    at_bound: bool
    identifiable: bool
    lower: float
    upper: float
    held: bool = False
    why: str | None = None

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "symbol": self.symbol,
            "value": self.value,
            "unit": self.unit,
            "stderr": self.stderr,
            "ci95": list(self.ci95) if self.ci95 else None,
            "at_bound": self.at_bound,
            "identifiable": self.identifiable,
            "held": self.held,
            "why": self.why,
        }


def estimates(
    problem: Problem, values: Array, lower: Array, upper: Array, errors: Errors = "robust"
) -> dict[str, Estimate]:
    """The parameters at the solution `values` [p] between bounds, by name."""
    if errors == "independent":
        residual, jacobian = problem.linearise(values)
        return estimates_by_rows(problem.model, values, lower, upper, jacobian, residual, None)
    residual = problem.residual(values)
    batch = batches(residual.size, correlation_length(residual))
    count = int(batch.max()) + 1
    parts = problem.triangles(values, np.arange(values.size), batch, count)
    factors = np.concatenate([part.factor for part in parts])
    rights = np.concatenate([part.right for part in parts])
    group = np.repeat(np.arange(count, dtype=np.uint32), values.size)
    return estimates_by_rows(problem.model, values, lower, upper, factors, rights, group)


def estimates_by_rows(
    model: Model,
    values: Array,
    lower: Array,
    upper: Array,
    jacobian: Array,
    residual: Array,
    batch: NDArray[np.uint32] | None,
) -> dict[str, Estimate]:
    """The parameters, from the problem linearised at the solution.

    Parameters
    ----------
    jacobian, residual : arrays [n, p] and [n]
        One row a sample, or the triangular factors of each batch: they have the same sums.
    batch : int array [n]
        Contiguous batches, from whose sums of scores the standard errors follow; None: errors are
        independent.
    """
    errors: Errors = "independent" if batch is None else "robust"
    held = lower == upper
    at_bound = ~held & _reached(values, lower, upper)
    shown = seen(jacobian, ~held, APART[errors])
    free = shown & ~at_bound
    if batch is None:
        freedom = residual.size - int(free.sum())
        covariance = independent(jacobian, residual, free)
    else:
        freedom = max(int(batch.max()), 1)
        covariance = sandwich(jacobian, residual, batch, free)
    quantile = float(scipy.special.stdtrit(freedom, 0.975))
    names = model.names
    made = {}
    for k, p in enumerate(model.parameters):
        error = float(np.sqrt(covariance[k, k])) if free[k] else None
        value = float(values[k])
        made[p.name] = Estimate(
            name=p.name,
            symbol=p.symbol,
            value=value,
            unit=p.unit,
            stderr=error,
            ci95=None if error is None else (value - quantile * error, value + quantile * error),
            at_bound=bool(at_bound[k]),
            identifiable=bool(shown[k]),
            lower=float(lower[k]),
            upper=float(upper[k]),
            held=bool(held[k]),
            why=None if shown[k] or held[k] else reason(names, partners(jacobian, k, ~held)),
        )
    return made


def _reached(values: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
    """Which values are at a bound, bool array [p]; an infinite bound is never reached."""
    size = np.where(np.isfinite(upper - lower), upper - lower, np.maximum(np.abs(values), 1.0))
    return np.asarray((values <= lower + AT_BOUND * size) | (values >= upper - AT_BOUND * size))
