"""Information criteria of fits whose residuals are correlated in time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.errors.covariance import correlation_length

__all__ = ["Information", "criteria", "effective_samples", "information"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Information:
    """Akaike's and the Bayesian information criterion of one fit; lower is better.

    Attributes
    ----------
    aic, bic
        ``m ln(S/n) + 2 k`` and ``m ln(S/n) + k ln(m)``, with S the sum of squares of n residuals, m
        the effective number of samples and k the number of parameters.
    parameters
        k: the parameters or combinations that the data determines, and the variance of the noise.
    samples, effective
        n and m.
    """

    aic: float
    bic: float
    parameters: int
    samples: int
    effective: float


def effective_samples(residual: Array) -> float:
    """Number of independent samples that determine as much as n correlated ones.

    n over the correlation length of the residual (Thiebaux and Zwiers 1984; as the sample size of
    information criteria, Jones 2011).
    """
    return residual.size / correlation_length(residual)


def information(residual: Array, rank: int, effective: float | None = None) -> Information | None:
    """The criteria of a fit by least squares, from its likelihood for normal errors.

    Parameters
    ----------
    residual : array [n]
    rank : int
        Number of parameters, or combinations of them, that the data determines.
    effective : float
        Effective number of samples; default: that of `residual`. It has to be the same for models
        that are compared.

    Returns
    -------
    Information or None
        None where the residual is zero.

    Examples
    --------
    >>> white = np.random.default_rng(0).standard_normal(1000)
    >>> found = information(white, 3)
    >>> found.samples, found.parameters, round(found.bic - found.aic - 4 * np.log(found.effective))
    (1000, 4, -8)
    """
    square = float(residual @ residual)
    if not (residual.size and square > 0.0):
        return None
    m = effective_samples(residual) if effective is None else effective
    k = rank + 1
    misfit = m * math.log(square / residual.size)
    return Information(misfit + 2.0 * k, misfit + k * math.log(m), k, residual.size, m)


def criteria(found: Information | None) -> dict[str, float | None]:
    """The JSON of the criteria; null where there are none."""
    return {
        "aic": None if found is None else found.aic,
        "bic": None if found is None else found.bic,
        "effective_samples": None if found is None else found.effective,
    }
