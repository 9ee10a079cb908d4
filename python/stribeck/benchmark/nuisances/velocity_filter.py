"""Velocity is the filtered difference of a coarse encoder."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Time constant of the filter, s.
LAG = (4e-3, 1.5e-2)
#: Encoder counts of the whole motion, as powers of two.
BITS = (13, 16)


def velocity_filter(bench: Bench, rng: np.random.Generator) -> Bench:
    """Round the position; velocity and acceleration are its filtered differences."""
    count = float(np.ptp(bench["position"])) / 2.0 ** int(rng.integers(*BITS))
    lag, dt = log_uniform(rng, *LAG), bench.dt
    position = np.round(bench["position"] / count) * count
    velocity = first_order(np.diff(position, prepend=position[0]) / dt, dt, lag)
    acceleration = first_order(np.diff(velocity, prepend=velocity[0]) / dt, dt, lag)
    return bench.with_channels(position=position, velocity=velocity, acceleration=acceleration)
