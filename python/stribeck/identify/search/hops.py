"""Coarse searches by Gauss-Newton steps, and hops from the best minimum to better ones nearby."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.separable import CAUTIOUS, Search, minimise_from
from stribeck.identify.search.space import SearchSpace

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: A coarse search between bounds ends when the predicted relative decrease of its next step is
#: smaller.
COARSE = 1e-6
#: A minimum is sought in the neighbourhood of the best one for laws with at least so many
#: nonlinear parameters.
HOPPING = 3
#: Hops in a round, and most rounds.
HOPS, MOST_ROUNDS = 8, 40
#: Rounds without a better minimum that end the search of a law with effects, which starts near the
#: minimum without the last effect; of a law alone, for each nonlinear parameter.
IDLE_ROUNDS, IDLE_ROUNDS_EACH = 6, 3
#: Relative decrease that counts as better.
BETTER = 2e-4
#: Smallest and largest size of a hop, in search coordinates, and the share of the parameters moved.
SMALLEST_HOP, LARGEST_HOP, MOVED_BY_HOP = 0.01, 0.5, 0.5


def gauss_newton(coarse: Problem, at: Array, space: SearchSpace, most: int) -> list[Search]:
    """Searches between bounds from `at`, array [k, p], of at most `most` steps each."""
    return minimise_from(
        coarse,
        at,
        space.lower,
        space.upper,
        most=most,
        damping=CAUTIOUS,
        logarithmic=space.logarithmic,
        tolerance=COARSE,
    )


def hopped(
    coarse: Problem, space: SearchSpace, best: Search, moved: Mask, seed: int, effort: Effort
) -> Search:
    """The best minimum in the neighbourhood of `best` (basin hopping, Wales and Doye 1997).

    Laws with many nonlinear parameters have minima within minima. Each hop starts from the best
    minimum so far, and changes some parameters by random steps of random size.
    """
    random = np.random.default_rng([seed, 1])
    count = int(space.nonlinear.sum())
    movable = moved[space.nonlinear]
    most_idle = IDLE_ROUNDS if coarse.model.effects else IDLE_ROUNDS_EACH * count
    evaluations, idle = best.evaluations, 0
    for _ in range(MOST_ROUNDS):
        at = []
        for _ in range(HOPS):
            size = SMALLEST_HOP * (LARGEST_HOP / SMALLEST_HOP) ** random.uniform()
            which = movable & (random.uniform(size=count) < MOVED_BY_HOP)
            at.append(space.moved(best.values, which * size * random.standard_normal(count)))
        found = gauss_newton(coarse, np.stack(at), space, effort.evaluations)
        evaluations += sum(search.evaluations for search in found)
        better = min(found, key=lambda search: search.square)
        idle = 0 if better.square < (1.0 - BETTER) * best.square else idle + 1
        best = better if better.square < best.square else best
        if idle == most_idle:
            break
    return replace(best, evaluations=evaluations)
