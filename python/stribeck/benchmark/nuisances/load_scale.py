"""The load torque follows from a mass that is 3 % wrong."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.nuisances.bench import Bench

#: Relative error.
ERROR = 0.03


def load_scale(bench: Bench, rng: np.random.Generator) -> Bench:
    """Scale the load torque."""
    return bench.with_channels(
        load_torque=bench["load_torque"] * (1 + ERROR * float(rng.choice([-1.0, 1.0])))
    )
