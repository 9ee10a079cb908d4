"""The nuisances of a recording: their choice, and the recording with them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from zlib import crc32

import numpy as np

from stribeck.benchmark.nuisances.bench import Bench, Nuisance
from stribeck.benchmark.nuisances.table import NUISANCES
from stribeck.benchmark.sample import Sample
from stribeck.benchmark.sealed.table import SEALED

EVERY: Mapping[str, Nuisance] = {**SEALED, **NUISANCES}


def drawn(
    pool: Collection[str], count: int, seed: int, fixed: Collection[str] = ()
) -> tuple[str, ...]:
    """Names for the recording of a `seed`, in the order of action.

    The names `fixed` and, up to a total of `count`, others of `pool` drawn at random.
    """
    rng = np.random.default_rng([seed, 101])
    others = rng.permutation(sorted(set(pool) - set(fixed)))
    chosen = {*fixed, *others[: count - len(fixed)]}
    return tuple(name for name in EVERY if name in chosen)


def distorted(sample: Sample, nuisances: Sequence[str], seed: int) -> Sample:
    """The recording with `nuisances`.

    Each draws from its own generator, so that it is the same with any others.

    Raises
    ------
    KeyError
        A name is unknown.
    """
    bench = Bench.of(sample)
    for name in nuisances:
        bench = EVERY[name](bench, np.random.default_rng([seed, 103, crc32(name.encode())]))
    return bench.sample({**sample.truth, "nuisances": list(nuisances)})
