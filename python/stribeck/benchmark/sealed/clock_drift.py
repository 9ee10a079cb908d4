"""Drive and torque logger have clocks of their own, which drift apart."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.nuisances.bench import Bench

#: Time by which the torque is late at the end of the recording, in sampling periods.
APART = (1.0, 3.0)


def clock_drift(bench: Bench, rng: np.random.Generator) -> Bench:
    """Read the torque at times that run away from those of the motion."""
    t = bench["time"]
    last = float(rng.choice([-1.0, 1.0])) * float(rng.uniform(*APART)) * bench.dt
    read = t - last * (t - t[0]) / (t[-1] - t[0])
    return bench.torque_through(lambda torque: np.interp(read, t, torque))
