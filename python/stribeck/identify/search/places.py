"""Which searches ended at the same place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.search.separable import Search
from stribeck.identify.search.space import SearchSpace

Array = NDArray[np.float64]

#: Coarse searches whose sums of squares agree to this share count as one.
SAME = 1e-4
#: Searches end at the same place if their search coordinates agree to this as well; without a
#: range of random starts there are none, and the values agree to this share.
NEAR = 0.01


def share_alone(leaders: NDArray[np.intp]) -> float:
    """The share of starts that ended where no other did."""
    _, sizes = np.unique(leaders, return_counts=True)
    return float(np.sum(sizes == 1)) / leaders.size


def leaders_of(ended: Sequence[Search], space: SearchSpace) -> NDArray[np.intp]:
    """For each coarse search the first that ended at the same place: itself or an earlier one."""
    squares = np.array([search.square for search in ended])
    leaders = np.arange(squares.size)
    if not space.nonlinear.any():
        return leaders
    values = np.stack([search.values for search in ended])
    places, sought = space.encode(values), values[:, space.nonlinear]
    for k in leaders[1:]:
        own = np.unique(leaders[:k])
        with np.errstate(invalid="ignore"):  # A sum is infinite where the model is not finite.
            level = np.abs(squares[k] - squares[own]) <= SAME * squares[own]
            near = np.all(_near(places[k], places[own], sought[k], sought[own]), axis=1)
        leaders[k] = next(iter(own[level & near]), k)
    return leaders


def _near(place: Array, places: Array, value: Array, values: Array) -> NDArray[np.bool_]:
    """Which coordinates of one search are near those of others, array [n, k]."""
    largest = np.maximum(np.abs(value), np.abs(values))
    by_range = np.abs(place - places) <= NEAR
    by_value = np.abs(value - values) <= NEAR * largest
    return np.where(np.isfinite(places), by_range, by_value)
