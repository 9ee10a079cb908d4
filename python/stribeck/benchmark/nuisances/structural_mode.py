"""The frame or the arm rings after each acceleration, and the motor carries the vibration."""

from __future__ import annotations

import math

import numpy as np
import scipy

from stribeck.benchmark.draws import log_uniform, root_mean_square
from stribeck.benchmark.nuisances.bench import Bench

#: Natural frequency, Hz; share of critical damping; RMS relative to the noise.
FREQUENCY, DAMPING, SIZE = (6.0, 25.0), (0.01, 0.05), (0.5, 1.5)


def structural_mode(bench: Bench, rng: np.random.Generator) -> Bench:
    """Add the reaction of an oscillator on the moved body to the torque."""
    omega, zeta = 2 * math.pi * log_uniform(rng, *FREQUENCY), log_uniform(rng, *DAMPING)
    # Deflection of the oscillator per acceleration of the body.
    oscillator = ([-1.0], [1.0, 2 * zeta * omega, omega**2])
    numerator, denominator, _ = scipy.signal.cont2discrete(oscillator, bench.dt, method="zoh")
    swing = scipy.signal.lfilter(np.ravel(numerator), denominator, bench["acceleration"])
    # What a rigid body of the same mass would carry is inertia, and known.
    swing = np.asarray(omega**2 * swing) + bench["acceleration"]
    reaction = swing / root_mean_square(swing) * log_uniform(rng, *SIZE) * bench.noise
    return bench.torque_through(lambda torque: torque + reaction)
