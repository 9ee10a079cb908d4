"""Dry friction with presliding hysteresis: the Maxwell slip model."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from stribeck.benchmark.open_loop.moves import Array

ELEMENTS = 24


def maxwell_slip(q: Array, reach: float, exponent: float) -> Array:
    """Factor of dry friction, in -1..1, of parallel elastic-slip elements along a path `q`.

    Between two reversals every element is min(spring, slip), so the result is exact for the sampled
    path.
    """
    nodes = np.arange(1, ELEMENTS + 1) / ELEMENTS
    curve = 1 - (1 - np.concatenate([[0.0], nodes])) ** exponent
    slope = np.append(np.diff(curve) * ELEMENTS, 0.0)
    weight = nodes * (slope[:-1] - slope[1:])
    limit = nodes * reach
    path = q[np.concatenate([[True], np.diff(q) != 0])]
    step = np.diff(path)
    turning = np.flatnonzero(step[1:] * step[:-1] < 0) + 1
    turning = np.concatenate([[0], turning, [len(path) - 1]])
    z, out = np.zeros(ELEMENTS), np.zeros_like(path)
    gain = weight / limit
    for i, j in pairwise(turning.tolist()):
        if j <= i:
            continue
        way = path[i + 1 : j + 1] - path[i]
        far = int(np.searchsorted(np.abs(way), 2 * reach))
        states = np.clip(z[:, None] + way[:far], -limit[:, None], limit[:, None])
        out[i + 1 : i + 1 + far] = gain @ states
        out[i + 1 + far : j + 1] = np.sign(way[-1])
        z = np.clip(z + way[-1], -limit, limit)
    return out[np.cumsum(np.diff(q, prepend=q[0]) != 0)]
