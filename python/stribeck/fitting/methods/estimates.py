"""Estimates for methods with their own standard errors."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.errors.estimates import Estimate
from stribeck.models.model import Model

Array = NDArray[np.float64]

#: A parameter is at its bound within this share of its range.
AT_BOUND = 1e-6


def reached_bounds(values: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
    """Which values are at a bound, bool array [p]."""
    bounded = np.isfinite(lower) & np.isfinite(upper)
    span = AT_BOUND * np.where(bounded, upper - lower, 0.0)
    return (values <= lower + span) | (values >= upper - span)


def estimates(
    model: Model, errors: Array, at_bound: NDArray[np.bool_], shown: NDArray[np.bool_]
) -> dict[str, Estimate]:
    """The model's parameters with their standard errors, by name.

    Parameters
    ----------
    model : Model
        With values and bounds.
    errors : array [p]
        Standard errors in the parameters' units; NaN where there is none. Intervals assume
        normally distributed estimates.
    at_bound, shown : bool array [p]
        Which values are at a bound, and which parameters are identifiable.
    """
    reach = float(scipy.special.ndtri(0.975))
    made = {}
    for k, p in enumerate(model.parameters):
        value = float(model.values[k])
        error = None if np.isnan(errors[k]) else float(errors[k])
        made[p.name] = Estimate.symmetric(
            p,
            value,
            error,
            reach,
            model.bounds[p.name],
            at_bound=bool(at_bound[k]),
            identifiable=bool(shown[k]),
        )
    return made
