"""How few of many parts carry most of a gain."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: The share of the gain that is looked at.
MOST = 0.9
#: Moves that must carry what is claimed.
FEWEST_MOVES = 5


def fewest(gains: Array) -> int:
    """How many of `gains`, none negative, sum to 90 % of all.

    Examples
    --------
    >>> fewest(np.array([1.0, 8.0, 0.5, 0.5]))
    2
    """
    largest = np.cumsum(np.sort(gains)[::-1])
    if largest.size == 0 or not largest[-1] > 0.0:
        return 0
    return int(np.searchsorted(largest, MOST * largest[-1])) + 1
