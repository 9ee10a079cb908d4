"""Many starts: coarse searches first, then the best of them are finished on all rows."""

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

#: Of coarse searches whose sums of squares agree to this share one is finished.
SAME = 1e-4
#: Searches have ended in the same place where their search coordinates agree to this as well.
NEAR = 0.01
#: A coarse search with so many times the sum of squares of the best one is not gone on with: more
#: rows will not make up for an error a fifth larger.
HOPELESS = 1.5
#: How often a coarse search that ends blind to a parameter begins anew at most.
ANEW = 3
#: Sums of squares that agree to this share are one minimum, or equal ones.
TIE = 1e-9
#: Without bounds, random starts lie within this factor of the given one, either way.
SPREAD = 10.0
#: A search of a model with a state begins on so many times fewer samples. Searches without bounds
#: take more steps, and a formula is slower than a law of the catalog: they have as many times fewer
#: rows.
FEWER = 4
#: A coarse search between bounds, and one without, ends when its next step foresees a smaller
#: relative fall.
COARSE, COARSE_WITHOUT_BOUNDS = 1e-6, 1e-12
#: Most steps of a search from the given start where there are no bounds.
MOST_STEPS = 200


@dataclass(frozen=True)
class Effort:
    """How thoroughly a model is fitted.

    Attributes
    ----------
    rows, samples
        Rows that a start is searched on before the best ones are finished on all rows, and the
        length of the stretch where a model has a state.
    evaluations
        Most evaluations of one start; 0: the start is near the minimum and needs no search.
    finished
        Starts that are finished on all rows, until the next step foresees a relative fall of the
        squared error below `tolerance`.
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
#: For one of many candidates, whose values are known roughly.
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

    Levenberg and Marquardt's method goes on from each. Between bounds, random starts are drawn
    evenly (evenly in the logarithm where a bound above zero allows it). Where a nonlinear parameter
    has no bounds, they lie within a factor of `SPREAD` of `start`, and from `start` itself it goes
    twice: in the logarithms of the parameters, which keep the sign, and in the parameters as they
    are.

    Parameters
    ----------
    varied : bool array [p]
        Parameters that random starts change; linear ones follow by themselves.

    Returns
    -------
    Search, starts, evaluations
    """
    space = SearchSpace(problem.model, lower, upper)
    nonlinear = space.nonlinear
    # Behind a bristle the torque is nearly linear in the amplitudes of dry friction: a search finds
    # them from anywhere, and random ones would only spoil the start.
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
    """The problem on fewer rows: on very few of them first where each costs much."""
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

    Where the height of a curve comes to zero, nothing leads back to a better one. A search that
    ends so begins anew further on, if a parameter that it is blind to is seen by one before it.
    """

    def searched(at: Array) -> list[Search]:
        return minimise_from(
            coarse, at, space.lower, space.upper, most=effort.evaluations, damping=CAUTIOUS,
            logarithmic=space.logarithmic, tolerance=COARSE,
        )  # fmt: skip

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
    """The searches that are blind to a parameter at their end which one before them sees."""
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
    """One of each group of searches that ended in the same place, best first."""
    ranked = sorted(tried, key=lambda search: search.square)
    return [ranked[k] for k in np.unique(_leaders(ranked, space))]


def _leaders(ended: Sequence[Search], space: SearchSpace) -> NDArray[np.intp]:
    """Of each coarse search the first that ended in the same place: itself or an earlier one."""
    places = space.encode(np.stack([search.values for search in ended]))
    squares = np.array([search.square for search in ended])
    leaders = np.arange(squares.size)
    for k in leaders[1:]:
        own = np.unique(leaders[:k])
        with np.errstate(invalid="ignore"):  # Where the model is not finite a square is infinite.
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
        On all rows.
    evaluations
        On fewer rows, and on all rows of a start that went on itself.
    leader
        The start that went on for this one: itself, or an earlier one that it had come to.
    """

    search: Search
    evaluations: int
    leader: int


def search_each(
    problem: Problem, lower: Array, upper: Array, starts: Array, effort: Effort
) -> list[Ended]:
    """The minimum on all rows that each of `starts` leads to, array [k, p], between bounds.

    Starts that a coarse search brings to the same place go on as one, the first of them: where a
    start ends depends on those before it and on none after it.
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
            coarse, at, lower, upper, most=most, damping=CAUTIOUS, logarithmic=logarithmic,
            tolerance=COARSE_WITHOUT_BOUNDS,
        )  # fmt: skip
        tried.extend(found)

    # First what keeps the given signs: a formula may have the same torque at several values.
    search(start[None, :], signed, MOST_STEPS)
    search(start[None, :], np.zeros_like(signed), MOST_STEPS)
    at = np.tile(start, (starts - 1, 1))
    for drawn in at:
        factor = SPREAD ** rng.uniform(-1.0, 1.0, size=start.size)
        drawn[moved] = np.where(signed, start * factor, factor - 1.0)[moved]
    search(np.clip(at, lower, upper), signed, effort.evaluations)
    return tried, sum(search.evaluations for search in tried)


def _distinct(tried: list[Search], noise: float) -> list[Search]:
    """The searches that ended in different places, best first.

    The first of those that found the same stands for them.
    """
    kept: list[Search] = []
    for search in sorted(tried, key=lambda search: search.square):
        if not any(abs(search.square - k.square) <= SAME * k.square for k in kept):
            kept.append(next(first for first in tried if _same(first, search, noise)))
    return kept


def _winner(finished: list[Search], noise: float) -> Search:
    """The lowest; of those that found the same, the first."""
    best = min(finished, key=lambda search: search.square)
    return next(search for search in finished if _same(search, best, noise))


def _same(one: Search, other: Search, noise: float) -> bool:
    """Whether two sums of squares differ by rounding alone.

    Parameters
    ----------
    noise : float
        Norm of the torque's rounding.
    """
    if one is other:
        return True
    margin = TIE * other.square + 16.0 * noise * np.sqrt(other.square) + noise**2
    return bool(abs(one.square - other.square) <= margin)
