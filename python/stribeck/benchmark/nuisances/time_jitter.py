"""A busy bus: channels are read at slightly different times, stamped late, and some rows lost."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.nuisances.bench import Array, Bench

#: Largest distance between the readings of torque and motion, and of the stamp, in periods.
APART, STAMPED = 0.4, 0.4
#: Share of the rows at which a loss begins, and mean number of rows lost.
LOSSES, LENGTH = 0.005, 2.0


def time_jitter(bench: Bench, rng: np.random.Generator) -> Bench:
    """Read the torque at other times, shift the time stamps, and drop rows."""
    t, dt = bench["time"], bench.dt
    read = t + dt * rng.uniform(-APART, APART, t.size)
    stamps = t + dt * rng.uniform(-STAMPED, STAMPED, t.size)

    def late(torque: Array) -> Array:
        return np.interp(read, t, torque)

    kept = np.ones(t.size, dtype=bool)
    for start in np.flatnonzero(rng.random(t.size) < LOSSES):
        kept[start : start + int(rng.geometric(1.0 / LENGTH))] = False
    return bench.torque_through(late).with_channels(time=stamps).kept(kept)
