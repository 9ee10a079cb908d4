"""Which samples of a long recording are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Samples drawn of one recording: a line has more than one for every pixel of the widest page, and
#: the figures in sight answer a selection in about a tenth of a second without a graphics card.
MOST_DRAWN = 4_000


def drawn_rows(
    channels: Sequence[Array],
    start: int,
    stop: int,
    most: int = MOST_DRAWN,
    breaks: NDArray[np.intp] | None = None,
) -> NDArray[np.intp]:
    """Samples from `start` to `stop` that are drawn: all, or the extremes of equal buckets.

    Each bucket keeps its first sample and the smallest and the largest value of every channel: a
    line through these samples covers the same pixels as one through all.

    Parameters
    ----------
    channels : sequence of arrays [n]
        The channels whose extremes are kept; NaN is no extreme.
    most
        Largest number of samples, without the breaks.
    breaks : array of int, optional
        Samples at which a line breaks: without them it would go on over a gap.

    Returns
    -------
    array of int
        Ascending, each once.

    Examples
    --------
    >>> spike = np.zeros(1000)
    >>> spike[517] = 1.0
    >>> 517 in drawn_rows([spike], 0, 1000, most=30)
    True
    >>> 23 in drawn_rows([spike], 0, 1000, 30, np.array([23]))
    True
    >>> drawn_rows([spike], 10, 14)
    array([10, 11, 12, 13])
    """
    count = max(stop - start, 0)
    if count <= most:
        return np.arange(start, start + count)
    size = -(-count // max(most // (1 + 2 * len(channels)), 1))
    buckets = -(-count // size)
    first = start + size * np.arange(buckets)
    kept = [first]
    for values in channels:
        padded = np.full(buckets * size, np.nan)
        padded[:count] = values[start:stop]
        table = padded.reshape(buckets, size)
        gone = np.isnan(table)
        kept.append(first + np.argmin(np.where(gone, np.inf, table), axis=1))
        kept.append(first + np.argmax(np.where(gone, -np.inf, table), axis=1))
    if breaks is not None and breaks.size <= most:
        kept.append(breaks[(breaks >= start) & (breaks < stop)])
    return np.unique(np.concatenate(kept))
