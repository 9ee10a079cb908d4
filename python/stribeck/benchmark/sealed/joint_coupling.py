"""Another joint moves at the same time, and its acceleration pulls at this one."""

from __future__ import annotations

import math

import numpy as np

from stribeck.benchmark.draws import log_uniform, root_mean_square
from stribeck.benchmark.nuisances.bench import Bench

#: RMS relative to the noise; duration of a move of the other joint, s.
SIZE, MOVE = (0.5, 1.5), (0.8, 2.5)


def joint_coupling(bench: Bench, rng: np.random.Generator) -> Bench:
    """Add the accelerations of moves at unrelated times to the torque."""
    t = bench["time"] - bench["time"][0]
    pulls = np.zeros_like(t)
    start = float(rng.uniform(*MOVE))
    while start < t[-1]:
        length = float(rng.uniform(*MOVE))
        u = np.clip((t - start) / length, 0.0, 1.0)
        pulls += float(rng.choice([-1.0, 1.0])) * np.sin(2 * math.pi * u) / length**2
        start += length + float(rng.uniform(0.2, 3.0))
    pulls *= log_uniform(rng, *SIZE) * bench.noise / root_mean_square(pulls)
    return bench.torque_through(lambda torque: torque + pulls)
