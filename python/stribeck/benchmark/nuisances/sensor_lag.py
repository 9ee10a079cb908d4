"""The load torque comes from a sensor with a slow amplifier."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Time constant of the sensor, s.
LAG = (4e-3, 1.2e-2)


def sensor_lag(bench: Bench, rng: np.random.Generator) -> Bench:
    """Filter the load torque."""
    return bench.with_channels(
        load_torque=first_order(bench["load_torque"], bench.dt, log_uniform(rng, *LAG))
    )
