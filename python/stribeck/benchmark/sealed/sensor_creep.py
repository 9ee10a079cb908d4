"""The body of the torque sensor creeps: a part of its reading comes late."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Part of the reading that creeps; time constant, s.
PART, LAG = (0.01, 0.04), (2.0, 20.0)


def sensor_creep(bench: Bench, rng: np.random.Generator) -> Bench:
    """Let a part of the torque follow slowly."""
    part, lag = log_uniform(rng, *PART), log_uniform(rng, *LAG)
    return bench.torque_through(
        lambda torque: (1.0 - part) * torque + part * first_order(torque, bench.dt, lag)
    )
