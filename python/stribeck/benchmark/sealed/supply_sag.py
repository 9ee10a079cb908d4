"""The supply sags with the power that is drawn, and the gain of the amplifier with it."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench, first_order

#: Loss of gain at the largest power; time constant of the supply, s.
LOSS, LAG = (0.01, 0.04), (0.05, 0.5)


def supply_sag(bench: Bench, rng: np.random.Generator) -> Bench:
    """Lower the torque while power is drawn."""
    power = np.maximum(bench["torque"] * bench["velocity"], 0.0)
    sag = first_order(power / float(power.max()), bench.dt, log_uniform(rng, *LAG))
    loss = log_uniform(rng, *LOSS)
    return bench.torque_through(lambda torque: torque * (1 - loss * sag))
