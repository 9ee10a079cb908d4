"""Robust losses: large residuals count less than their squares.

Huber (1964) and Cauchy losses of the residual over its scale, with the tuning constants of 95 %
efficiency for normal errors (Holland and Welsch 1977). The scale is the median of the absolute
residuals over 0.6745, which is the standard deviation of normal errors (Huber and Ronchetti 2009,
section 5.1). They are minimised as weighted squares whose weights follow the residual (iteratively
reweighted least squares).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

__all__ = ["LOSSES", "Loss", "LossName", "robust_scale"]

Array = NDArray[np.float64]

#: How residuals count.
LossName = Literal["squares", "huber", "cauchy"]
LOSSES: tuple[str, ...] = get_args(LossName)
#: Residuals beyond so many scales count less.
TUNING = {"huber": 1.345, "cauchy": 2.385}
#: The median of the absolute values of normal errors, in standard deviations.
MEDIAN_OF_NORMAL = 0.6744897501960817


def robust_scale(residual: Array) -> float:
    """The standard deviation of normal errors with the median absolute value of `residual` [m].

    Examples
    --------
    >>> round(robust_scale(np.array([-1.0, 0.5, 1.0, 1000.0, -0.2])), 4)
    1.4826
    """
    return float(np.median(np.abs(residual))) / MEDIAN_OF_NORMAL if residual.size else 0.0


@dataclass(frozen=True)
class Loss:
    """A robust loss with its scale, in the unit of the residual."""

    name: LossName
    scale: float

    @property
    def _bend(self) -> float:
        return TUNING[self.name] * self.scale

    def weights(self, residual: Array) -> Array:
        """Weights [m] of the squares, whose gradient is that of the loss."""
        u = np.abs(residual) / self._bend
        if self.name == "huber":
            return np.asarray(1.0 / np.maximum(u, 1.0))
        return np.asarray(1.0 / (1.0 + u * u))

    def total(self, residual: Array) -> float:
        """The loss of all residuals; equal to the sum of squares where they are small."""
        bend, u = self._bend, np.abs(residual) / self._bend
        if self.name == "huber":
            each = np.where(u <= 1.0, u * u, 2.0 * u - 1.0)
        else:
            each = np.log1p(u * u)
        return float(bend * bend * np.sum(each))

    def pseudo(self, residual: Array) -> Array:
        """Residuals [m] with which the formulas of least squares give the standard errors.

        The derivative of the loss over its mean slope (Huber and Ronchetti 2009, section 7.6).
        """
        u = np.abs(residual) / self._bend
        if self.name == "huber":
            slope = (u <= 1.0).astype(np.float64)
        else:
            slope = (1.0 - u * u) / (1.0 + u * u) ** 2
        return np.asarray(self.weights(residual) * residual / np.mean(slope))
