"""The torque arrives more rarely than the motion: some rows repeat the value before."""

from __future__ import annotations

import numpy as np

from stribeck.benchmark.nuisances.bench import Array, Bench

#: Share of the rows that repeat the torque of the row before.
STALE = (0.1, 0.4)


def stale_rows(bench: Bench, rng: np.random.Generator) -> Bench:
    """Repeat the torque of the row before in some rows."""
    rows = np.arange(bench["time"].size)
    fresh = rng.random(rows.size) >= float(rng.uniform(*STALE))
    fresh[0] = True
    source = np.maximum.accumulate(np.where(fresh, rows, 0))

    def repeated(torque: Array) -> Array:
        return torque[source]

    return bench.torque_through(repeated)
