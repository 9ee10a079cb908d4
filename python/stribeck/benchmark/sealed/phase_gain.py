"""The phases of the current sensor differ: the torque reads more at some motor angles."""

from __future__ import annotations

import math

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench

#: Electrical periods in the stroke; largest relative error of the torque.
PERIODS, ERROR = (3.0, 30.0), (0.005, 0.02)


def phase_gain(bench: Bench, rng: np.random.Generator) -> Bench:
    """Scale the torque with the angle of the motor, twice in an electrical period."""
    q = bench["position"]
    wave = 4.0 * math.pi * log_uniform(rng, *PERIODS) / float(np.ptp(q))
    phase, error = float(rng.uniform(0.0, 2.0 * math.pi)), log_uniform(rng, *ERROR)
    return bench.torque_through(lambda torque: torque * (1.0 + error * np.cos(wave * q + phase)))
