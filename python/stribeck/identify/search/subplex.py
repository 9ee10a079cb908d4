"""The best ends of coarse searches continue by nlopt's subplex, which crosses low ridges."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.identify.problem import Problem
from stribeck.identify.search.algorithms import search_from
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.hops import BETTER, gauss_newton
from stribeck.identify.search.separable import Search
from stribeck.identify.search.space import SearchSpace

#: Ends that continue, most evaluations of each, and most rounds from the best of them.
CONTINUED, EVALUATIONS, MOST_ROUNDS = 3, 600, 4


def beyond_ridges(
    coarse: Problem, space: SearchSpace, best: Search, others: list[Search], effort: Effort
) -> Search:
    """The best minimum that subplex (Rowan 1990) finds from `best` and the best of `others`.

    Gauss-Newton steps end at the first minimum. Subplex needs no gradient and takes long steps at
    first, so it leaves shallow minima. Gauss-Newton steps follow, and another round from the best
    end, until a round brings nothing.
    """
    worse = sorted((end for end in others if end.square > best.square), key=lambda end: end.square)
    at = np.stack([end.values for end in (best, *worse[: CONTINUED - 1])])
    evaluations = best.evaluations
    for _ in range(MOST_ROUNDS):
        left = search_from(coarse, space, at, "sbplx", EVALUATIONS)
        ends = np.stack([search.values for search in left])
        found = [*left, *gauss_newton(coarse, ends, space, effort.evaluations)]
        evaluations += sum(search.evaluations for search in found)
        least = min(found, key=lambda search: search.square)
        better = least.square < (1.0 - BETTER) * best.square
        best = least if least.square < best.square else best
        if not better:
            break
        at = best.values[None, :]
    return replace(best, evaluations=evaluations)
