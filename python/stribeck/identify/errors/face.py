"""Standard errors of a fit with priors, ties, active constraints or a robust loss.

At an active constraint the parameters can move along it only: their covariance is that of the
coordinates on this face, carried to the parameters by the chain rule, as for tied parameters.
A prior is a further row with a variance of its own. A robust loss takes the pseudo-residuals of
`Loss.pseudo` in place of the residual.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.constrained.objective import Objective
from stribeck.identify.constrained.optimality import Optimality
from stribeck.identify.constrained.region import Region
from stribeck.identify.errors.confounded import partners, reason
from stribeck.identify.errors.covariance import batches, correlation_length, sandwich
from stribeck.identify.errors.directions import Directions
from stribeck.identify.errors.estimates import (
    APART,
    APART_INDEPENDENT,
    Errors,
    Estimate,
    Identified,
    reached,
)
from stribeck.identify.errors.matrix import ParameterMatrix
from stribeck.identify.triangle import Triangle, triangles

__all__ = ["estimates_on_face"]

Array = NDArray[np.float64]

#: Conditions whose slopes are combinations of others, to this share, are no further conditions.
SAME = 1e-9
#: A column of the Jacobian shorter than this share of the longest is none.
NOTHING = 1e-100
#: A parameter is not identifiable if it moves by more than this along a hidden direction, in units
#: in which its effect on the prediction is 1.
MOVES = 1e-2


def estimates_on_face(
    objective: Objective, values: Array, region: Region, optimality: Optimality, errors: Errors
) -> Identified:
    """The parameters at the solution `values` [p]."""
    problem = objective.problem
    residual, jacobian = map(problem.weighted, problem.linearise(values))
    size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
    # A column of almost nothing, such as a tail of an exponential, would overflow when inverted.
    jacobian = np.where(size > NOTHING * size.max(initial=0.0), jacobian, 0.0)
    if objective.loss is not None:
        residual = objective.loss.pseudo(residual)
    at_bound = (region.lower < region.upper) & reached(values, region.lower, region.upper)
    at_bound[region.ties.places] = False
    basis = _basis(values, region, optimality, at_bound)
    prior = _prior_rows(objective, basis)
    noise = 0.0 if objective.prior is None else objective.prior.noise
    face = _Face.of(jacobian @ basis, residual, prior, noise, errors)
    covariance = basis @ face.covariance @ basis.T
    lost = _lost(jacobian, basis, objective, face.hidden)
    return _identified(objective, values, region, jacobian, covariance, lost, at_bound, face)


@dataclass(frozen=True)
class _Face:
    """Covariance [k, k] of the coordinates on the face, degrees of freedom, rank; directions [h, k]
    in which nothing is determined."""

    covariance: Array
    freedom: int
    rank: int
    hidden: Array

    @classmethod
    def of(
        cls, jacobian: Array, residual: Array, prior: Array, noise: float, errors: Errors
    ) -> _Face:
        """From J [m, k], r [m] and the rows [q, k] of the priors, whose errors are `noise`."""
        apart = APART_INDEPENDENT if errors == "independent" else APART
        count = jacobian.shape[1]
        free = np.ones(count, dtype=bool)
        # A prior determines its parameter however weak it is.
        size = np.sqrt(np.einsum("ij,ij->", jacobian, jacobian)) or 1.0
        strong = prior / np.maximum(np.abs(prior).max(axis=1, initial=0.0), 1e-300)[:, None] * size
        shown = Directions.of(np.concatenate([jacobian, strong]), free)
        rank = shown.rank(apart)
        hidden = np.zeros((shown.hidden(apart).shape[0], count))
        hidden[:, shown.index] = shown.hidden(apart) / shown.size
        jacobian = shown.without_hidden(jacobian, apart)
        whole = Triangle.of(np.concatenate([jacobian, prior]), np.zeros(residual.size + len(prior)))
        inverse = whole.covariance()
        if errors == "independent":
            freedom = max(residual.size - rank, 1)
            return cls(float(residual @ residual) / freedom * inverse, freedom, rank, hidden)
        batch = batches(residual.size, correlation_length(residual))
        groups = int(batch.max()) + 1
        parts = triangles(jacobian, residual, batch, groups)
        factors = np.concatenate([*(part.factor for part in parts), prior])
        rights = np.concatenate([*(part.right for part in parts), np.zeros(len(prior))])
        group = np.repeat(np.arange(groups, dtype=np.uint32), count)
        # The rows of priors have no score here: its variance, `noise^2` a row, is added.
        group = np.concatenate([group, np.zeros(len(prior), dtype=np.uint32)])
        made = sandwich(factors, rights, group, free)
        of_prior = inverse @ prior.T
        made += noise**2 * (of_prior @ of_prior.T)
        return cls(made, max(groups - 1, 1), rank, hidden)


def _basis(
    values: Array, region: Region, optimality: Optimality, at_bound: NDArray[np.bool_]
) -> Array:
    """Directions [p, k] in which the parameters can move on the face of active conditions."""
    directions = region.directions(values)
    _, slopes = region.finite_shares(values)
    bounds = np.eye(region.free.size)[at_bound[region.free]]
    active = np.concatenate([slopes[optimality.active], bounds])
    if active.shape[0] == 0:
        return directions
    size = np.where(values[region.free] == 0.0, 1.0, np.abs(values[region.free]))
    active = active * size
    norms = np.sqrt(np.einsum("ij,ij->i", active, active))
    active = active[norms > 0.0] / norms[norms > 0.0, None]
    return np.asarray(directions @ (size[:, None] * linear.null_space(active, SAME)))


def _prior_rows(objective: Objective, basis: Array) -> Array:
    prior = objective.prior
    return np.empty((0, basis.shape[1])) if prior is None else prior.rows(basis)


def _lost(jacobian: Array, basis: Array, objective: Objective, hidden: Array) -> NDArray[np.bool_]:
    """Which parameters are not identifiable, bool array [p]."""
    size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
    lost = size == 0.0
    if objective.prior is not None:
        lost[objective.prior.places] = False
    if hidden.shape[0]:
        moves = np.abs(basis @ hidden.T).max(axis=1) * size
        lost |= moves > MOVES
    return np.asarray(lost)


def _identified(
    objective: Objective,
    values: Array,
    region: Region,
    jacobian: Array,
    covariance: Array,
    lost: NDArray[np.bool_],
    at_bound: NDArray[np.bool_],
    face: _Face,
) -> Identified:
    """The parameters with their standard errors, from their covariance [p, p]."""
    model = objective.problem.model
    held = np.ones(values.size, dtype=bool)
    held[region.wanted] = False
    quantile = float(scipy.special.stdtrit(face.freedom, 0.975))
    known = ~held & ~lost & ~at_bound & (np.diag(covariance) > 0.0)
    made = {}
    for k, p in enumerate(model.parameters):
        error = float(np.sqrt(covariance[k, k])) if known[k] else None
        value, free = float(values[k]), not held[k]
        unseen = bool(lost[k]) and free
        made[p.name] = Estimate.symmetric(
            p,
            value,
            error,
            quantile,
            (float(region.lower[k]), float(region.upper[k])),
            at_bound=bool(at_bound[k]),
            identifiable=free and not unseen,
            held=not free,
            why=reason(model.names, partners(jacobian, k, ~held)) if unseen else None,
        )
    chosen = np.flatnonzero(known)
    names = tuple(model.names[k] for k in chosen)
    among = ParameterMatrix(names, covariance[np.ix_(chosen, chosen)])
    return Identified(made, among, (), face.rank)
