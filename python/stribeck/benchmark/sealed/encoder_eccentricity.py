"""The disc of the encoder is off centre: position and speed are wrong once per turn."""

from __future__ import annotations

import math

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench

#: Turns of the disc in the stroke; largest relative error of the speed.
TURNS, ERROR = (1.0, 8.0), (0.005, 0.02)


def encoder_eccentricity(bench: Bench, rng: np.random.Generator) -> Bench:
    """Distort position and velocity with the angle of the disc."""
    q, v = bench["position"], bench["velocity"]
    wave = 2 * math.pi * log_uniform(rng, *TURNS) / float(np.ptp(q))
    phase, error = float(rng.uniform(0, 2 * math.pi)), log_uniform(rng, *ERROR)
    faster = error * np.cos(wave * q + phase)
    return bench.with_channels(
        position=q + error / wave * np.sin(wave * q + phase),
        velocity=v * (1 + faster),
        acceleration=bench["acceleration"] * (1 + faster)
        - error * wave * np.sin(wave * q + phase) * v**2,
    )
