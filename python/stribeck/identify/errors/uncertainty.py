"""The parameters of a fit with the errors that were asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.checks import check_choice, check_count
from stribeck.base.errors import SpecError, option
from stribeck.identify.errors.bootstrap import Resamples, resampled
from stribeck.identify.errors.covariance import batches, correlation_length, variances
from stribeck.identify.errors.estimates import (
    APART,
    ERRORS,
    Errors,
    Identified,
    estimates_by_rows,
)
from stribeck.identify.errors.profile import Profile
from stribeck.identify.problem import Problem
from stribeck.identify.search.delays import error_across_minima, free_delay
from stribeck.identify.search.separable import Search, minimise

Array = NDArray[np.float64]

#: Refits of the bootstrap, and the fewest of which the ends of a 95 % interval are quantiles.
RESAMPLES, FEWEST = 200, 40
#: A minimum that is lower by this share of the rise at the ends of an interval is another one.
LOWER = 0.01


@dataclass(frozen=True)
class Uncertainty:
    """How standard errors and intervals are computed.

    Attributes
    ----------
    errors
        What they assume, or from what they follow.
    resamples, seed
        Number of refits of the bootstrap, and the seed of its draws.
    plain
        Whether the fit is by least squares, without other conditions than bounds.

    Raises
    ------
    SpecError
        An unknown kind, one that needs a plain fit, or too few resamples.
    """

    errors: Errors = "robust"
    resamples: int = RESAMPLES
    seed: int = 0
    plain: bool = True

    def __post_init__(self) -> None:
        check_choice("errors", self.errors, ERRORS)
        check_count("resamples", self.resamples, FEWEST)
        if self.errors in ("profile", "bootstrap") and not self.plain:
            raise SpecError(
                f"{option('errors', self.errors)} refits by least squares within bounds: omit "
                f"{option('passive')} and {option('estimator', 'iv')}, or choose "
                f"{option('errors', 'robust')}"
            )


def identified(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    by: Uncertainty,
    search: Search | None = None,
) -> Identified:
    """The parameters at the solution `values` [p] between bounds.

    Parameters
    ----------
    search
        The search that found them: it may know other minima of a delay.
    """
    if by.errors == "independent":
        residual, jacobian = map(problem.weighted, problem.linearise(values))
        return estimates_by_rows(problem.model, values, lower, upper, jacobian, residual, None)
    residual = problem.weighted(problem.residual(values))
    length = correlation_length(residual)
    rows = _linearised(problem, values, batches(residual.size, length))
    found = estimates_by_rows(problem.model, values, lower, upper, *rows)
    if by.errors == "profile":
        return _with_profiles(problem, values, lower, upper, rows, found)
    if by.errors == "bootstrap":
        refits = resampled(
            problem, values, lower, upper, length=length, resamples=by.resamples, seed=by.seed
        )
        return _with_refits(found, refits)
    if search is not None and search.others:
        return _across_minima(problem, values, lower, upper, rows, found, search)
    return found


Rows = tuple[Array, Array, NDArray[np.uint32]]


def _linearised(problem: Problem, values: Array, batch: NDArray[np.uint32]) -> Rows:
    """Triangular factors of the problem in each batch at `values`, and the batch of each row."""
    count = int(batch.max()) + 1
    parts = problem.triangles(values, np.arange(values.size), batch, count)
    factors = np.concatenate([part.factor for part in parts])
    rights = np.concatenate([part.right for part in parts])
    return factors, rights, np.repeat(np.arange(count, dtype=np.uint32), values.size)


def _with_profiles(
    problem: Problem, values: Array, lower: Array, upper: Array, rows: Rows, found: Identified
) -> Identified:
    """The parameters with intervals of the profile likelihood, those at a bound too."""
    model, (jacobian, residual, batch) = problem.model, rows
    quantile = float(scipy.special.stdtrit(max(int(batch.max()), 1), 0.975))
    known = [found.estimates[name] for name in model.names]
    free = np.array([not (e.held or e.at_bound) for e in known])
    best = minimise(problem, values, lower, upper)
    made, notes = dict(found.estimates), []
    for k, e in enumerate(known):
        if e.held or not e.identifiable:
            continue
        own, independent = variances(jacobian, residual, batch, free, k, APART)
        if own <= 0.0:
            continue  # The residual is zero.
        profile = Profile(problem, best.values, lower, upper, best.square, k, independent, quantile)
        interval = profile.interval(quantile * float(np.sqrt(own)))
        made[e.name] = replace(e, ci95=(interval.low, interval.high), open=interval.open)
        if profile.least < best.square - LOWER * quantile**2 * independent:
            notes.append(
                f"the interval of {e.name} contains a smaller error than that of the fit: try more "
                f"starts"
            )
    return replace(found, estimates=made, notes=tuple(notes))


def _across_minima(
    problem: Problem,
    values: Array,
    lower: Array,
    upper: Array,
    rows: Rows,
    found: Identified,
    search: Search,
) -> Identified:
    """The parameters with the error of a delay across its minima that fit as well."""
    k = int(np.flatnonzero(free_delay(problem, lower, upper))[0])
    known = list(found.estimates.values())
    delay = known[k]
    if delay.stderr is None or delay.ci95 is None or not delay.stderr > 0.0:
        return found
    jacobian, residual, batch = rows
    free = np.array([not (e.held or e.at_bound) for e in known])
    _, rise = variances(jacobian, residual, batch, free, k, APART)
    wider = error_across_minima(k, search, values, delay.stderr, rise) / delay.stderr
    if not wider > 1.0:
        return found
    low, high = (delay.value + wider * (end - delay.value) for end in delay.ci95)
    widened = replace(delay, stderr=wider * delay.stderr, ci95=(low, high))
    scale = np.array([wider if name == delay.name else 1.0 for name in found.covariance.names])
    covariance = replace(found.covariance, values=found.covariance.values * scale[:, None] * scale)
    return replace(found, estimates={**found.estimates, delay.name: widened}, covariance=covariance)


def _with_refits(found: Identified, refits: Resamples) -> Identified:
    """The parameters with the errors of the bootstrap, with an interval also for those at a bound.

    An end at a bound is open.
    """
    covariance = refits.covariance()
    made = dict(found.estimates)
    for k, e in enumerate(made.values()):
        if e.held or not e.identifiable:
            continue
        low, high = refits.interval(k)
        ends = ("lower", low <= e.lower), ("upper", high >= e.upper)
        made[e.name] = replace(
            e,
            stderr=None if e.at_bound else float(np.sqrt(covariance[k, k])),
            ci95=(low, high),
            open=tuple(side for side, is_open in ends if is_open),
        )
    chosen = [k for k, name in enumerate(made) if name in found.covariance.names]
    notes: tuple[str, ...] = ()
    if refits.unsettled:
        notes = (
            f"{refits.unsettled} of {refits.values.shape[0]} refits of the bootstrap did not "
            f"converge",
        )
    return replace(
        found,
        estimates=made,
        covariance=replace(found.covariance, values=covariance[np.ix_(chosen, chosen)]),
        notes=notes,
    )
