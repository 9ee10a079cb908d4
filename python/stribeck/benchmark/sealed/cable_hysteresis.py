"""A cable pack pulls back, and not along the same curve in both directions."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform, root_mean_square
from stribeck.benchmark.nuisances.bench import Bench

#: RMS relative to the noise; travel in strokes over which the hysteresis turns over.
SIZE, REACH = (0.5, 1.5), (0.1, 0.4)
#: Share of the torque that remembers the direction.
REMEMBERS = (0.2, 0.6)


def cable_hysteresis(bench: Bench, rng: np.random.Generator) -> Bench:
    """Add a spring, and a slider behind another spring, to the torque."""
    q = bench["position"]
    stroke = float(np.ptp(q))
    reach = stroke * log_uniform(rng, *REACH)
    memory = np.empty_like(q)
    slider = 0.0
    for i, step in enumerate(np.diff(q, prepend=q[0])):
        slider = min(max(slider + step / reach, -1.0), 1.0)
        memory[i] = slider
    spring = (q - q.mean()) / stroke
    share = float(rng.uniform(*REMEMBERS))
    pull = (1 - share) * spring / root_mean_square(spring)
    pull += share * memory / root_mean_square(memory)
    pull *= log_uniform(rng, *SIZE) * bench.noise / root_mean_square(pull)
    return bench.torque_through(lambda torque: torque + pull)
