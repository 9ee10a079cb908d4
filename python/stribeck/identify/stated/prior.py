"""Gaussian priors of parameters.

A prior of mean m and standard deviation d is one more row of the least-squares problem,
``noise (x - m)/d``, where `noise` is the standard deviation of the errors of the samples (mixed
estimation, Theil and Goldberger 1961). For white noise of this level the result is the mean of the
posterior, and ``noise^2 (J'J)^-1`` with this row its covariance. Errors that are correlated in time
determine the parameters as fewer independent ones would: their variance is multiplied by the
correlation length of the residual (the magnitude adjustment of a likelihood that takes the samples
as independent; Pauli, Racugno and Ventura 2011).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.models.model import Model

__all__ = ["Prior"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Prior:
    """The priors of a model's parameters, with the level of the noise.

    Attributes
    ----------
    places : int array [q]
        Index of each parameter in the model.
    mean, deviation : arrays [q]
        In the parameters' units.
    noise
        Standard deviation of the errors of the samples, weighted, in the unit of torque.
    """

    places: NDArray[np.intp]
    mean: Array
    deviation: Array
    noise: float = 1.0

    @classmethod
    def of(cls, model: Model) -> Prior:
        """The priors of a model whose parameters it has."""
        known = {name: k for k, name in enumerate(model.names)}
        own = [(known[n], *prior) for n, prior in model.stated.priors.items() if n in known]
        rows = np.array(own, dtype=np.float64).reshape(len(own), 3)
        return cls(rows[:, 0].astype(np.intp), rows[:, 1], rows[:, 2])

    def rows(self, directions: Array) -> Array:
        """Rows [q, k] of the Jacobian, from the derivatives [p, k] of all parameters."""
        return (self.noise / self.deviation)[:, None] * directions[self.places]

    def right(self, values: Array) -> Array:
        """Their residuals [q] at the values [p]."""
        return self.noise / self.deviation * (self.mean - values[self.places])
