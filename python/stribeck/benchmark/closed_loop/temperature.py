"""Temperature of the joint."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def draw_temperature(rng: np.random.Generator, time: Array, limit: str | None = None) -> Array:
    """Temperature of each row: load cycles warm the joint, and it cools between them.

    With a `limit` it is constant ("isothermal") or only rises ("warm_up_only").
    """
    start, span = float(rng.uniform(18.0, 32.0)), float(rng.uniform(15.0, 27.0))
    u = time / time[-1]
    if limit == "isothermal":
        return np.full_like(time, start)
    if limit == "warm_up_only":
        return np.asarray(start + span * (1 - np.exp(-1.5 * u)) / (1 - math.exp(-1.5)))
    cycles, phase = float(rng.uniform(1.3, 2.2)), float(rng.uniform(-0.15, 0.15))
    wave = np.sin(math.pi * cycles * (u + phase)) ** 2
    return np.asarray(start + span * wave * (1 - 0.25 * u))
