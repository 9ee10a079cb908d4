"""The current amplifier warms up: its gain and its zero settle during the recording."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.nuisances.bench import Bench

#: Change of the gain, of the zero relative to the unknown torque, and time constant as a share of
#: the recording.
GAIN, ZERO, SETTLES = (0.01, 0.03), (0.01, 0.04), (0.15, 0.5)


def amplifier_warm_up(bench: Bench, rng: np.random.Generator) -> Bench:
    """Change gain and zero of the torque with time."""
    t = bench["time"] - bench["time"][0]
    cold = np.exp(-t / (log_uniform(rng, *SETTLES) * float(t[-1])))
    gain, zero = (float(rng.choice([-1.0, 1.0])) * log_uniform(rng, *of) for of in (GAIN, ZERO))
    shift = zero * bench.unknown * cold
    return bench.torque_through(lambda torque: torque * (1 + gain * cold) + shift)
