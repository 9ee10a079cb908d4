"""Where searches start: points of low discrepancy, the same for the same seed."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.search.reduced import squares
from stribeck.identify.search.space import SearchSpace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Points of which a screened start is the best.
SCREENED = 16
#: Samples, and contiguous samples of a model with memory, on which points are compared.
ROWS, SAMPLES = 500, 3000
#: Without bounds, random starts are the given one times or divided by at most this factor.
SPREAD = 10.0


def starts_between_bounds(
    problem: Problem, space: SearchSpace, first: Array, moved: Mask, count: int, seed: int
) -> Array:
    """`first` and further starts, array [count, p].

    They are of three kinds in turn, all scrambled Sobol points (Owen 1998): uniform in the search
    coordinates, which finds minima anywhere; uniform in values at the mean temperature and their
    relative changes; and the best of `SCREENED` points of the second kind, which finds the likely
    minimum with most of the starts. A start depends on the seed and its number alone.

    Parameters
    ----------
    problem
        A problem of few samples, on which points are compared.
    first : array [p]
        The first start.
    moved : bool array [p]
        Parameters that starts change.
    """
    each = -(-max(count - 1, 0) // 3)
    starts = np.tile(first, (1 + 3 * each, 1))
    if each:
        plain = space.placed(first, _points(space, each, seed, 0))
        centred = space.placed_at_mean_temperature(first, _points(space, each, seed, 1))
        many = space.placed_at_mean_temperature(first, _points(space, SCREENED * each, seed, 2))
        for drawn in (plain, centred, many):
            drawn[:, ~moved] = first[~moved]
        screened = best_of(problem, space, many.reshape(each, SCREENED, -1))
        starts[1:] = np.stack([screened, plain, centred], axis=1).reshape(3 * each, -1)
    return starts[:count]


def best_of(problem: Problem, space: SearchSpace, points: Array) -> Array:
    """The point with the least sum of squares of each row of `points` [n, m, p]: array [n, p]."""
    fewer = problem.thinned(ROWS) if problem.model.memoryless else problem.window(SAMPLES)
    n, m, p = points.shape
    found = squares(fewer, points.reshape(n * m, p), space.lower, space.upper)
    return points[np.arange(n), np.argmin(found.reshape(n, m), axis=1)]


def _points(space: SearchSpace, count: int, seed: int, kind: int) -> Array:
    """Points of low discrepancy in 0..1, array [count, k]."""
    dimension = int(space.nonlinear.sum())
    sobol = scipy.stats.qmc.Sobol(dimension, rng=np.random.default_rng([seed, kind]))
    return np.asarray(sobol.random_base2((count - 1).bit_length())[:count])


def starts_without_bounds(
    space: SearchSpace, start: Array, moved: Mask, count: int, seed: int
) -> Array:
    """Starts within a factor of `SPREAD` of `start`, array [count, p]."""
    random = np.random.default_rng(seed)
    signed = space.nonlinear & (start != 0.0)
    at = np.tile(start, (count, 1))
    for drawn in at:
        factor = SPREAD ** random.uniform(-1.0, 1.0, size=start.size)
        drawn[moved] = np.where(signed, start * factor, factor - 1.0)[moved]
    return np.clip(at, space.lower, space.upper)
