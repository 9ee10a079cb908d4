"""The drive reports its current behind a low-pass filter; the motion channels are not filtered."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Time constant of the filter, s: cut-off between 20 and 80 Hz.
LAG = (2e-3, 8e-3)


def current_filter(bench: Bench, rng: np.random.Generator) -> Bench:
    """Filter the torque."""
    lag, dt = log_uniform(rng, *LAG), bench.dt
    return bench.torque_through(lambda torque: first_order(torque, dt, lag))
