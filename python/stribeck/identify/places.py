"""Which searches ended at the same place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.separable import Search
from stribeck.identify.space import SearchSpace

#: Coarse searches whose sums of squares agree to this share count as one.
SAME = 1e-4
#: Searches end at the same place if their search coordinates agree to this as well.
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
    places = space.encode(np.stack([search.values for search in ended]))
    for k in leaders[1:]:
        own = np.unique(leaders[:k])
        with np.errstate(invalid="ignore"):  # A sum is infinite where the model is not finite.
            level = np.abs(squares[k] - squares[own]) <= SAME * squares[own]
            near = np.all(np.abs(places[k] - places[own]) <= NEAR, axis=1)
        leaders[k] = next(iter(own[level & near]), k)
    return leaders
