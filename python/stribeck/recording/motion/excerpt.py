"""Contiguous stretches of a recording, evenly distributed."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from stribeck.recording.recording import Recording

__all__ = ["SAMPLE_ROWS", "excerpt", "stretches"]

#: Samples in which causes are searched by default: they show as much as millions, in seconds.
SAMPLE_ROWS = 100_000

#: Number of stretches: each is long enough for a motion, and slow changes are seen as well.
STRETCHES = 40


def stretches(rows: int, most: int, seed: int) -> list[tuple[int, int]]:
    """First and last row (exclusive) of stretches of equal length, one in each equal share.

    The place of a stretch in its share is random, so that a periodic motion is not always sampled
    at the same phase.

    Examples
    --------
    >>> stretches(1000, 1000, seed=0)
    [(0, 1000)]
    >>> len(stretches(10_000_000, 200_000, seed=0))
    40
    """
    if rows <= most:
        return [(0, rows)]
    count = min(STRETCHES, most)
    length = most // count
    borders = np.arange(count + 1) * rows // count
    room = np.diff(borders) - length
    first = borders[:-1] + np.random.default_rng(seed).integers(0, room + 1)
    return [(int(begin), int(begin) + length) for begin in first]


def excerpt(recording: Recording, most: int, seed: int = 0) -> Recording:
    """At most `most` samples of a recording; the recording itself if it has no more.

    Each stretch begins a segment. Held-out blocks, runs and the filtered channels are those of the
    whole recording.
    """
    size = recording.rows
    if size <= most:
        return recording
    taken = stretches(size, most, seed)
    rows = np.concatenate([np.arange(*stretch) for stretch in taken])
    own = {}
    for field in fields(recording):
        value = getattr(recording, field.name)
        if isinstance(value, np.ndarray) and value.shape == (size,):
            own[field.name] = value[rows]
    begins = np.cumsum([0, *(stop - start for start, stop in taken)])[:-1]
    own["dt"][begins] = 0.0
    changes = np.diff(own["segment"], prepend=own["segment"][:1]) != 0
    changes[begins[1:]] = True
    own["segment"] = np.cumsum(changes)
    return replace(recording, **own, excerpt_of=recording)
