"""The temperature of the joint over time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from stribeck.benchmark.open_loop.moves import Array


def joint_temperature(
    rng: np.random.Generator, duration: float, limit: str | None
) -> Callable[[Array], Array]:
    """Joint temperature: it rises and falls with a duty cycle, so it is not monotone in time."""
    grid = np.arange(-1.0, duration + 1.0, 0.05)
    start, span = rng.uniform(19.0, 30.0), rng.uniform(14.0, 28.0)
    if limit == "isothermal":
        return lambda t: start + 0 * t
    if limit == "warm_up_only":
        return lambda t: start + span * np.maximum(t, 0) / duration
    while True:
        power, t, on = np.zeros_like(grid), grid[0], True
        while t < grid[-1]:
            length = rng.uniform(0.1, 0.24) * duration
            power[grid >= t] = rng.uniform(0.75, 1.0) if on else rng.uniform(0.0, 0.2)
            t, on = t + length, not on
        tau = rng.uniform(0.09, 0.16) * duration
        k = 0.05 / tau
        smooth = scipy.signal.lfilter([k * 4], [1, -(1 - k * 4)], power)
        rise = np.asarray(scipy.signal.lfilter([k], [1, -(1 - k)], smooth))
        rise /= rise.max()
        if abs(np.corrcoef(rise, grid)[0, 1]) < 0.6:
            return lambda t: start + span * np.interp(t, grid, rise)
