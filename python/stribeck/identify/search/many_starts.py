"""Searches from many starts: on few samples first; the best continue on all samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.search.algorithms import GAUSS_NEWTON, GLOBAL, search_from, search_range
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.ends import Found
from stribeck.identify.search.finish import MOST_STEPS, finished
from stribeck.identify.search.hops import HOPPING, gauss_newton, hopped
from stribeck.identify.search.places import SAME, leaders_of, share_alone
from stribeck.identify.search.separable import (
    CAUTIOUS,
    Search,
    minimise_from,
)
from stribeck.identify.search.space import SearchSpace
from stribeck.identify.search.starts import starts_between_bounds, starts_without_bounds
from stribeck.identify.search.subplex import beyond_ridges

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: A search on very few samples with more than so many times the sum of squares of the best one is
#: dropped: more samples will not compensate for an error larger by a fifth.
HOPELESS = 1.5
#: Searches on very few samples that continue on more.
CONTINUED = 6
#: Most restarts of a coarse search that ends where a parameter has no effect.
ANEW = 3
#: A search of a model with a state starts on so many times fewer samples.
FEWER = 2
#: So do searches without bounds, which take more steps, often of a formula, which is slower than a
#: law of the catalog.
FEWER_WITHOUT_BOUNDS = 4
#: A coarse search without bounds ends when the predicted relative decrease of its next step is
#: smaller.
COARSE_WITHOUT_BOUNDS = 1e-12
#: As many starts again are searched where more than this share of them ended alone.
UNSURE = 0.3
#: The neighbourhood of the best minimum is searched unless this share of the starts ended there,
#: and so many of them.
AGREED, FEWEST_AGREED = 1.0 / 3.0, 2


def multi_start(
    problem: Problem,
    lower: Array,
    upper: Array,
    start: Array,
    varied: Mask,
    starts: int,
    seed: int,
    effort: Effort,
) -> Found:
    """The best of searches from `start` and from others.

    The starts are searched on few samples. Those that end apart from each other, best first,
    continue on all samples by Gauss-Newton steps. Where a nonlinear parameter has no bounds, random
    starts lie within a factor of `SPREAD` of `start`, and `start` itself is searched twice: in the
    logarithms of the parameters, which keep their signs, and in the parameters.

    Parameters
    ----------
    varied : bool array [p]
        Parameters that random starts change; linear ones are solved for.
    """
    space = SearchSpace.of(problem, lower, upper)
    moved = varied & space.sought
    starts = max(starts, 1) if moved.any() else 1
    if not space.nonlinear.any() or effort.evaluations == 0:
        tried = [Search(start, np.inf, True, "", 0)]
    elif space.enclosed:
        tried = _between_bounds(problem, space, start, moved, starts, seed, effort)
    else:
        tried = _without_bounds(problem, space, start, moved, starts, seed, effort)
    return finished(problem, space, tried, effort)


def _coarse(problem: Problem, effort: Effort) -> list[Problem]:
    """The problem on fewer samples: on very few of them first if the model has a memory."""
    if problem.model.memoryless:
        return [problem.thinned(effort.rows)]
    first, second = problem.window(effort.samples // FEWER), problem.window(effort.samples)
    return [second] if first is second else [first, second]


def _between_bounds(
    problem: Problem,
    space: SearchSpace,
    start: Array,
    moved: Mask,
    starts: int,
    seed: int,
    effort: Effort,
) -> list[Search]:
    """The coarse search of each start.

    With a memory, starts that are far behind on very few samples do not continue on more.
    """
    first, *rest = _coarse(problem, effort)
    if effort.algorithm in GLOBAL:
        most = starts * effort.evaluations
        end = search_range(first, space, start, effort.algorithm, most, seed)
        tried = [_searched(first, end.values[None, :], space, effort)[0].continuing(end)]
    else:
        at = starts_between_bounds(first, space, start, moved, starts, seed)
        tried = _searched(first, at, space, effort)
    for more in rest:
        continued = _promising(tried, space)
        at = np.stack([tried[k].values for k in continued])
        # On more samples the sum of squares is larger: those that stay behind are compared by what
        # they had in excess.
        best = min(search.square for search in tried)
        found = _searched(more, at, space, effort)
        level = min(search.square for search in found) / best if best > 0.0 else 1.0
        tried = [replace(search, square=search.square * level) for search in tried]
        for k, search in zip(continued, found, strict=True):
            tried[k] = search.continuing(tried[k])
        first = more
    if moved.sum() < HOPPING or not problem.in_core or effort.algorithm != GAUSS_NEWTON:
        return tried
    best = int(np.argmin([search.square for search in tried]))
    leaders = leaders_of(tried, space)
    agreed = int(np.sum(leaders == leaders[best]))
    if agreed >= max(AGREED * len(tried), FEWEST_AGREED):
        return tried
    if share_alone(leaders) > UNSURE:
        at = starts_between_bounds(first, space, start, moved, 2 * starts, seed)[starts:]
        others = _searched(first, at, space, effort)
        tried[best] = _better(tried[best], others)
    if not problem.model.effects:
        own = [tried[k] for k in np.unique(leaders).tolist() if k != best]
        tried[best] = beyond_ridges(first, space, tried[best], own, effort)
    tried[best] = hopped(first, space, tried[best], moved, seed, effort)
    return tried


def _better(one: Search, others: list[Search]) -> Search:
    """The search with the least sum of squares, with the evaluations of all."""
    evaluations = sum(search.evaluations for search in (one, *others))
    return replace(min((one, *others), key=lambda search: search.square), evaluations=evaluations)


def _promising(tried: list[Search], space: SearchSpace) -> list[int]:
    """Indices of searches that ended at different places, best first, without hopeless ones."""
    leaders = np.unique(leaders_of(tried, space)).tolist()
    ranked = sorted(leaders, key=lambda k: tried[k].square)
    near = [k for k in ranked if tried[k].square <= HOPELESS * tried[ranked[0]].square]
    return (near or ranked)[:CONTINUED]


def _searched(coarse: Problem, at: Array, space: SearchSpace, effort: Effort) -> list[Search]:
    """Coarse searches between bounds from `at`, array [k, p].

    Where the height of a curve becomes zero, its other parameters have no effect and the search
    cannot continue. Such a search starts again elsewhere if an earlier search ended where these
    parameters have an effect.
    """
    found = _descended(coarse, at, space, effort)
    at = at.copy()
    for _ in range(ANEW):
        lost = _lost(found, space)
        if not lost:
            break
        for k in lost:
            at[k] = space.further(at[k], found[k].blind)
        for k, again in zip(lost, _descended(coarse, at[list(lost)], space, effort), strict=True):
            better = again if again.square < found[k].square else found[k]
            found[k] = replace(better, evaluations=found[k].evaluations + again.evaluations)
    return found


def _descended(coarse: Problem, at: Array, space: SearchSpace, effort: Effort) -> list[Search]:
    """One coarse search from each of `at`, array [k, p]; nlopt's ends take Gauss-Newton steps."""
    if effort.algorithm == GAUSS_NEWTON or effort.algorithm in GLOBAL:
        return gauss_newton(coarse, at, space, effort.evaluations)
    found = search_from(coarse, space, at, effort.algorithm, effort.evaluations)
    ends = np.stack([search.values for search in found])
    steps = gauss_newton(coarse, ends, space, effort.evaluations)
    return [other.continuing(one) for one, other in zip(found, steps, strict=True)]


def _lost(found: list[Search], space: SearchSpace) -> list[int]:
    """Indices of searches that end without effect of a parameter, unlike an earlier search."""
    everything = set(np.flatnonzero(space.nonlinear).tolist())
    seen: set[int] = set()
    lost = []
    for k, search in enumerate(found):
        if seen.intersection(search.blind):
            lost.append(k)
        if np.isfinite(search.square):
            seen |= everything.difference(search.blind)
    return lost


def _without_bounds(
    problem: Problem,
    space: SearchSpace,
    start: Array,
    moved: Mask,
    starts: int,
    seed: int,
    effort: Effort,
) -> list[Search]:
    """Coarse searches where a nonlinear parameter has no bounds, in order."""
    lower, upper = space.lower, space.upper
    few = FEWER_WITHOUT_BOUNDS
    fewer = replace(effort, rows=effort.rows // few, samples=effort.samples // few)
    coarse = _coarse(problem, fewer)[-1]
    signed = space.nonlinear & (start != 0.0)

    def searched(at: Array, logarithmic: Mask, most: int) -> list[Search]:
        return minimise_from(
            coarse,
            at,
            lower,
            upper,
            most=most,
            damping=CAUTIOUS,
            logarithmic=logarithmic,
            tolerance=COARSE_WITHOUT_BOUNDS,
        )

    at = starts_without_bounds(space, start, moved, starts - 1, seed)
    if effort.algorithm != GAUSS_NEWTON:
        given = np.concatenate([start[None, :], at])
        return _descended(coarse, given, space, effort)
    # First the search that keeps the signs: a formula may have the same torque at several values.
    signs = searched(start[None, :], signed, MOST_STEPS)[0]
    free = searched(start[None, :], np.zeros_like(signed), MOST_STEPS)[0]
    first = free if free.square < (1.0 - SAME) * signs.square else signs
    first = replace(first, evaluations=signs.evaluations + free.evaluations)
    return [first, *searched(at, signed, effort.evaluations)]
