"""The torque sensor reads nothing near zero."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench

#: Half the width relative to the unknown torque.
WIDTH = (0.02, 0.08)


def torque_dead_zone(bench: Bench, rng: np.random.Generator) -> Bench:
    """Shrink the torque towards zero."""
    width = log_uniform(rng, *WIDTH) * bench.unknown
    return bench.torque_through(
        lambda torque: np.sign(torque) * np.maximum(np.abs(torque) - width, 0.0)
    )
