"""The minima of a delay: the error has one near each sample.

The sign of a delayed velocity changes sample by sample, so a search from one delay ends near it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.problem import Problem
from stribeck.identify.search.separable import Search

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Samples by which a delay is shifted to find the other minima, and how often at most.
SHIFTS, MOST_SHIFTS = (-2.0, -1.0, 1.0, 2.0), 5


def free_delay(problem: Problem, lower: Array, upper: Array) -> Bools:
    """Which of the parameters [p] is a delay between different bounds; none at steady points."""
    if not problem.recording.rate_hz > 0.0:
        return np.zeros(lower.size, dtype=bool)
    named = np.array([name == "delay" for name in problem.model.names], dtype=bool)
    return named & (lower < upper)


def across_samples(
    problem: Problem,
    found: Search,
    lower: Array,
    upper: Array,
    steps: Callable[[Array], list[Search]],
) -> Search:
    """The best search from `found`, and from delays that differ by a few samples.

    It is `found` where no delay is free.

    Parameters
    ----------
    steps
        Searches from several starts [k, p].
    """
    delay = free_delay(problem, lower, upper)
    if not delay.any():
        return found
    period = 1.0 / problem.recording.rate_hz
    evaluations = found.evaluations
    others: list[Search] = []
    for _ in range(MOST_SHIFTS):
        at = np.tile(found.values, (len(SHIFTS), 1))
        at[:, delay] += period * np.array(SHIFTS)[:, None]
        tried = steps(np.clip(at, lower, upper))
        evaluations += sum(search.evaluations for search in tried)
        best = min([found, *tried], key=lambda search: search.square)
        others += [search for search in (found, *tried) if search is not best]
        if best is found:
            break
        found = best
    return replace(found, evaluations=evaluations, others=tuple(others))


def error_across_minima(
    delay: int, found: Search, values: Array, stderr: float, rise: float
) -> float:
    """The standard error of a delay whose error has several minima.

    Parameters
    ----------
    delay
        Index of the parameter.
    found
        The search that found `values` [p], with the ends of those from other delays.
    stderr
        That at the minimum, s.
    rise
        By how much the sum of squares rises where a parameter is one standard error away.
    """
    if not rise > 0.0:
        return stderr
    error = stderr
    for other in found.others:
        errors_apart = float(np.sqrt(max((other.square - found.square) / rise, 1.0)))
        error = max(error, abs(float(other.values[delay] - values[delay])) / errors_apart)
    return error
