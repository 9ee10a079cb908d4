"""Searches from many starts: on few samples first; the best continue on all samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.separable import (
    CAUTIOUS,
    TOLERANCE,
    Search,
    minimise,
    minimise_from,
    rounding,
)
from stribeck.identify.space import SearchSpace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Coarse searches whose sums of squares agree to this share count as one.
SAME = 1e-4
#: Searches end at the same place if their search coordinates agree to this as well.
NEAR = 0.01
#: A coarse search with more than so many times the sum of squares of the best one is dropped: more
#: samples will not compensate for an error larger by a fifth.
HOPELESS = 1.5
#: Most restarts of a coarse search that ends where a parameter has no effect.
ANEW = 3
#: Sums of squares that agree to this share are at one minimum, or at equal minima.
TIE = 1e-9
#: Without bounds, random starts are the given one times or divided by at most this factor.
SPREAD = 10.0
#: A search of a model with a state starts on so many times fewer samples. So do searches without
#: bounds, which take more steps, often of a formula, which is slower than a law of the catalog.
FEWER = 4
#: A coarse search with bounds, and one without, ends when the predicted relative decrease of its
#: next step is smaller.
COARSE, COARSE_WITHOUT_BOUNDS = 1e-6, 1e-12
#: Most steps of a search from the given start where there are no bounds.
MOST_STEPS = 200


@dataclass(frozen=True)
class Effort:
    """How thoroughly a model is fitted.

    Attributes
    ----------
    rows, samples
        Samples used for the coarse search of each start; contiguous ones, `samples`, where a model
        has a state.
    evaluations
        Most evaluations of one start; 0: the start is near the minimum and needs no search.
    finished
        Number of starts that continue on all samples, until the predicted relative decrease of the
        sum of squares is below `tolerance`.
    exact
        Whether held-out predictions evaluate the model at each refit, or its linearisation.
    """

    rows: int = 4000
    samples: int = 12000
    evaluations: int = 60
    finished: int = 2
    tolerance: float = TOLERANCE
    exact: bool = True


#: For a fit that is reported.
THOROUGH = Effort()
#: For one of many candidates whose values are roughly known.
QUICK = Effort(evaluations=0, finished=1, tolerance=1e-6, exact=False)


def multi_start(
    problem: Problem,
    lower: Array,
    upper: Array,
    start: Array,
    varied: Mask,
    starts: int,
    seed: int,
    effort: Effort,
) -> tuple[Search, int, int]:
    """The best of searches from `start` and from random ones.

    Each start is continued by Levenberg and Marquardt's method. With bounds, random starts are
    uniform between them (uniform in the logarithm where the lower bound is above zero). Where a
    nonlinear parameter has no bounds, they lie within a factor of `SPREAD` of `start`, and `start`
    itself is searched twice: in the logarithms of the parameters, which keep their signs, and in
    the parameters.

    Parameters
    ----------
    varied : bool array [p]
        Parameters that random starts change; linear ones are solved for.

    Returns
    -------
    Search, starts, evaluations
    """
    space = SearchSpace(problem.model, lower, upper)
    nonlinear = space.nonlinear
    # With a bristle the torque is nearly linear in the amplitudes of dry friction: a search finds
    # them from any start, and random ones would only make the start worse.
    amplitude = np.array([p.role == "dry" for p in problem.model.parameters])
    moved = varied & nonlinear & ~amplitude
    starts = max(starts, 1) if moved.any() else 1
    bounded = bool(np.all(np.isfinite(lower[nonlinear]) & np.isfinite(upper[nonlinear])))
    rng = np.random.default_rng(seed)
    if not nonlinear.any() or effort.evaluations == 0:
        tried, evaluations = [Search(start, np.inf, True, "", 0)], 0
    elif bounded:
        tried, evaluations = _between_bounds(problem, space, start, moved, starts, rng, effort)
    else:
        tried, evaluations = _without_bounds(problem, space, start, moved, starts, rng, effort)
    noise = rounding(problem)
    finished = []
    for search in _distinct(tried, noise)[: effort.finished]:
        done = minimise(problem, search.values, lower, upper, tolerance=effort.tolerance)
        evaluations += done.evaluations
        finished.append(done)
    return _winner(finished, noise), starts, evaluations


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
    rng: np.random.Generator,
    effort: Effort,
) -> tuple[list[Search], int]:
    """Coarse searches, best first, and their evaluations."""
    at = np.tile(start, (starts, 1))
    for drawn in at[1:]:
        drawn[moved] = space.drawn(start, rng)[moved]
    evaluations = 0
    tried: list[Search] = []
    for coarse in _coarse(problem, effort):
        tried = _searched(coarse, at, space, effort)
        evaluations += sum(search.evaluations for search in tried)
        apart = _apart(tried, space)
        tried = [search for search in apart if search.square <= HOPELESS * apart[0].square]
        tried = tried[: effort.finished]
        at = np.stack([search.values for search in tried])
    return tried, evaluations


def _searched(coarse: Problem, at: Array, space: SearchSpace, effort: Effort) -> list[Search]:
    """Coarse searches between bounds from `at`, array [k, p].

    Where the height of a curve becomes zero, its other parameters have no effect and the search
    cannot continue. Such a search starts again elsewhere if an earlier search ended where these
    parameters have an effect.
    """

    def searched(at: Array) -> list[Search]:
        return minimise_from(
            coarse,
            at,
            space.lower,
            space.upper,
            most=effort.evaluations,
            damping=CAUTIOUS,
            logarithmic=space.logarithmic,
            tolerance=COARSE,
        )

    found = searched(at)
    at = at.copy()
    for _ in range(ANEW):
        lost = _lost(found, space)
        if not lost:
            break
        for k in lost:
            at[k] = space.further(at[k], found[k].blind)
        for k, again in zip(lost, searched(at[list(lost)]), strict=True):
            evaluations = found[k].evaluations + again.evaluations
            better = again if again.square < found[k].square else found[k]
            found[k] = replace(better, evaluations=evaluations)
    return found


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


def _apart(tried: list[Search], space: SearchSpace) -> list[Search]:
    """One of each group of searches that ended at the same place, best first."""
    ranked = sorted(tried, key=lambda search: search.square)
    return [ranked[k] for k in np.unique(_leaders(ranked, space))]


def _leaders(ended: Sequence[Search], space: SearchSpace) -> NDArray[np.intp]:
    """For each coarse search the first that ended at the same place: itself or an earlier one."""
    places = space.encode(np.stack([search.values for search in ended]))
    squares = np.array([search.square for search in ended])
    leaders = np.arange(squares.size)
    for k in leaders[1:]:
        own = np.unique(leaders[:k])
        with np.errstate(invalid="ignore"):  # A sum is infinite where the model is not finite.
            level = np.abs(squares[k] - squares[own]) <= SAME * squares[own]
        near = np.all(np.abs(places[k] - places[own]) <= NEAR, axis=1)
        leaders[k] = next(iter(own[level & near]), k)
    return leaders


@dataclass(frozen=True)
class Ended:
    """Where one of several starts ended.

    Attributes
    ----------
    search
        The search on all samples.
    evaluations
        Evaluations on fewer samples, and on all samples where this start itself continued.
    leader
        The start that continued for this one: itself, or an earlier one that reached the same
        place.
    """

    search: Search
    evaluations: int
    leader: int


def search_each(
    problem: Problem, lower: Array, upper: Array, starts: Array, effort: Effort
) -> list[Ended]:
    """The minimum on all samples that each of `starts` leads to, array [k, p], between bounds.

    Of starts that a coarse search brings to the same place only the first continues. So the result
    of a start depends on earlier starts, not on later ones.
    """
    space = SearchSpace(problem.model, lower, upper)
    leader = np.arange(starts.shape[0])
    evaluations = np.zeros(leader.size, dtype=np.int64)
    at = starts.copy()
    coarse = _coarse(problem, effort) if space.nonlinear.any() else []
    for fewer in coarse:
        own = np.unique(leader)
        found = _searched(fewer, at[own], space, effort)
        for k, search in zip(own, found, strict=True):
            at[k] = search.values
            evaluations[k] += search.evaluations
        leader = own[_leaders(found, space)][np.searchsorted(own, leader)]
    own = np.unique(leader)
    done = minimise_from(problem, at[own], lower, upper, tolerance=effort.tolerance)
    ends = dict(zip(own, done, strict=True))
    for k, search in ends.items():
        evaluations[k] += search.evaluations
    return [
        Ended(ends[first], int(count), int(first))
        for first, count in zip(leader, evaluations, strict=True)
    ]


def _without_bounds(
    problem: Problem,
    space: SearchSpace,
    start: Array,
    moved: Mask,
    starts: int,
    rng: np.random.Generator,
    effort: Effort,
) -> tuple[list[Search], int]:
    """Coarse searches in order, and their evaluations."""
    lower, upper = space.lower, space.upper
    fewer = replace(effort, rows=effort.rows // FEWER, samples=effort.samples // FEWER)
    coarse = _coarse(problem, fewer)[-1]
    signed = space.nonlinear & (start != 0.0)
    tried: list[Search] = []

    def search(at: Array, logarithmic: Mask, most: int) -> None:
        found = minimise_from(
            coarse,
            at,
            lower,
            upper,
            most=most,
            damping=CAUTIOUS,
            logarithmic=logarithmic,
            tolerance=COARSE_WITHOUT_BOUNDS,
        )
        tried.extend(found)

    # First the search that keeps the signs: a formula may have the same torque at several values.
    search(start[None, :], signed, MOST_STEPS)
    search(start[None, :], np.zeros_like(signed), MOST_STEPS)
    at = np.tile(start, (starts - 1, 1))
    for drawn in at:
        factor = SPREAD ** rng.uniform(-1.0, 1.0, size=start.size)
        drawn[moved] = np.where(signed, start * factor, factor - 1.0)[moved]
    search(np.clip(at, lower, upper), signed, effort.evaluations)
    return tried, sum(search.evaluations for search in tried)


def _distinct(tried: list[Search], noise: float) -> list[Search]:
    """The searches that ended at different places, best first.

    Of those with the same sum of squares the first is kept.
    """
    kept: list[Search] = []
    for search in sorted(tried, key=lambda search: search.square):
        if not any(abs(search.square - k.square) <= SAME * k.square for k in kept):
            kept.append(next(first for first in tried if _same(first, search, noise)))
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
