"""The thermometer sits on the housing, and follows the temperature of the contacts late."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Time constant as a share of the recording.
LAG = (0.03, 0.1)
#: Resolution of the thermometer, K.
STEP = 0.1


def lagging_thermometer(bench: Bench, rng: np.random.Generator) -> Bench:
    """Filter the temperature, and round it."""
    t = bench["time"]
    lag = log_uniform(rng, *LAG) * float(t[-1] - t[0])
    late = first_order(bench["temperature"], bench.dt, lag)
    return bench.with_channels(temperature=np.round(late / STEP) * STEP)
