"""What a fit minimises: weighted squares or a robust loss of the residual, and priors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.identify.constrained.region import Region
from stribeck.identify.problem import Problem
from stribeck.identify.stated.loss import Loss
from stribeck.identify.stated.prior import Prior
from stribeck.identify.triangle import Triangle

__all__ = ["Objective", "Point"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Point:
    """An objective linearised at some values.

    Attributes
    ----------
    triangle
        Factor of the rows of samples and priors, by the free parameters of a region.
    cost
        The loss of all samples, and the squares of the priors.
    """

    triangle: Triangle
    cost: float


@dataclass(frozen=True)
class Objective:
    """A least-squares problem with the statements of a user.

    Attributes
    ----------
    loss
        None: squares.
    """

    problem: Problem
    prior: Prior | None = None
    loss: Loss | None = None

    def at(self, values: Array, region: Region) -> Point | None:
        """The objective linearised at `values` [p]; None where the model is not finite."""
        try:
            with np.errstate(all="ignore"):
                residual, jacobian = self.problem.linearise(values, region.wanted)
        except (ValueError, FitError):
            # A law of the catalog refuses values at which it is not defined.
            return None
        residual, jacobian = self.problem.weighted(residual), self.problem.weighted(jacobian)
        if not (np.all(np.isfinite(residual)) and np.all(np.isfinite(jacobian))):
            return None
        cost = float(residual @ residual)
        if self.loss is not None:
            cost = self.loss.total(residual)
            root = np.sqrt(self.loss.weights(residual))
            residual, jacobian = residual * root, jacobian * root[:, None]
        if region.ties.places.size:
            jacobian = jacobian @ region.directions(values)[region.wanted]
        triangle = Triangle.of(jacobian, residual)
        if self.prior is None:
            return Point(triangle, cost)
        right = self.prior.right(values)
        return Point(self.with_prior(triangle, values, region), cost + float(right @ right))

    def with_prior(self, triangle: Triangle, values: Array, region: Region) -> Triangle:
        """A factor by the free parameters of `region`, with the rows of the priors."""
        if self.prior is None or self.prior.places.size == 0:
            return triangle
        rows, right = self.prior.rows(region.directions(values)), self.prior.right(values)
        extra = Triangle.of(rows, right)
        return Triangle.joined([triangle, extra])

    def weighted_residual(self, values: Array) -> Array:
        """The residual [m], times the square roots of the weights that were given."""
        return self.problem.weighted(self.problem.residual(values))
