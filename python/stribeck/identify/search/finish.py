"""The best of coarse searches continue on all samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.search.delays import across_samples
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.ends import Ended, Found, StartsReport
from stribeck.identify.search.hops import gauss_newton
from stribeck.identify.search.places import leaders_of, share_alone
from stribeck.identify.search.separable import MOST_ROUNDS, Search, minimise, rounding
from stribeck.identify.search.space import SearchSpace

Array = NDArray[np.float64]

#: Sums of squares that agree to this share are at one minimum, or at equal minima.
TIE = 1e-9
#: Searches whose sum of squares on few samples is larger than the least by at most this share also
#: continue on all samples, up to `MOST_FINISHED`: on all samples another one may be the best.
CLOSE, MOST_FINISHED = 2e-3, 5
#: Searches of a model with a state that are compared on all samples, after so many steps.
COMPARED, COMPARED_STEPS = 10, 12
#: Steps from each delay that is tried beside that of a minimum.
DELAY_STEPS = 3
#: Most steps of a search on all samples.
MOST_STEPS = 200


def finished(problem: Problem, space: SearchSpace, tried: list[Search], effort: Effort) -> Found:
    """Continue the best of coarse searches on all samples."""
    noise = rounding(problem)
    leaders = leaders_of(tried, space)
    if problem.model.has_state and space.enclosed and len(tried) > 1:
        tried = _compared(problem, space, tried, leaders)
    evaluations = [search.evaluations for search in tried]
    done: dict[int, Search] = {}
    for k in _continued(tried, leaders, noise, effort.finished):
        found = _descended(problem, space, tried[k].values, effort)
        evaluations[k] += found.evaluations
        done[int(leaders[k])] = found
    ends = tuple(
        Ended(done.get(leader, tried[leader]), count, leader, leader in done)
        for leader, count in zip(leaders.tolist(), evaluations, strict=True)
    )
    best = _winner(list(done.values()), noise)
    alone = share_alone(leaders) if len(tried) > 1 else None
    at_minimum = sum(end.search is best for end in ends)
    report = StartsReport(effort.algorithm, at_minimum, alone)
    return Found(best, ends, sum(evaluations), report)


def _descended(problem: Problem, space: SearchSpace, start: Array, effort: Effort) -> Search:
    """The search on all samples from one start; not near a minimum, it tries other delays too."""
    searched = bool(effort.evaluations)
    most = MOST_STEPS if searched else MOST_ROUNDS
    lower, upper = space.lower, space.upper

    def descended(values: Array) -> Search:
        return minimise(problem, values, lower, upper, tolerance=effort.tolerance, most=most)

    found = descended(start)
    if not searched:
        return found
    other = across_samples(
        problem, found, lower, upper, lambda at: gauss_newton(problem, at, space, DELAY_STEPS)
    )
    if other.square < found.square:
        return descended(other.values).continuing(other)
    return other


def _compared(
    problem: Problem, space: SearchSpace, tried: list[Search], leaders: NDArray[np.intp]
) -> list[Search]:
    """The best coarse searches after a few steps on all samples; the others count as worse.

    Few contiguous samples do not show what changes slowly, so the best of coarse searches of a
    model with a state need not be the best on all samples.
    """
    own = sorted(np.unique(leaders).tolist(), key=lambda k: tried[k].square)[:COMPARED]
    at = np.stack([tried[k].values for k in own])
    stepped = dict(zip(own, gauss_newton(problem, at, space, COMPARED_STEPS), strict=True))
    return [
        stepped[k].continuing(search) if k in stepped else replace(search, square=np.inf)
        for k, search in enumerate(tried)
    ]


def _continued(
    tried: list[Search], leaders: NDArray[np.intp], noise: float, finished: int
) -> list[int]:
    """Indices of the searches that continue on all samples, best first.

    Of those at one place the first continues, or the first whose sum of squares is the same but for
    rounding.
    """
    ranked = sorted(np.unique(leaders).tolist(), key=lambda k: tried[k].square)
    close = (1.0 + CLOSE) * tried[ranked[0]].square
    kept: list[int] = []
    for k in ranked:
        few = len(kept) < finished or (
            finished > 1 and len(kept) < MOST_FINISHED and tried[k].square <= close
        )
        if few and not any(_same(tried[k], tried[j], noise) for j in kept):
            first = next(j for j, other in enumerate(tried) if _same(other, tried[k], noise))
            kept.append(first if leaders[first] == first else k)
    return kept


def _winner(finished: list[Search], noise: float) -> Search:
    """The search with the least sum of squares; of equal ones the first."""
    best = min(finished, key=lambda search: search.square)
    return next(search for search in finished if _same(search, best, noise))


def _same(one: Search, other: Search, noise: float) -> bool:
    """Whether two sums of squares differ only by rounding.

    Parameters
    ----------
    noise : float
        Norm of the rounding of the torque.
    """
    if one is other:
        return True
    margin = TIE * other.square + 16.0 * noise * np.sqrt(other.square) + noise**2
    return bool(abs(one.square - other.square) <= margin)
