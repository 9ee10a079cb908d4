"""The search for a motion: differential evolution in each family (Storn and Price 1997)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.motion.design.information import Wanted, least_information
from stribeck.motion.design.motion import Family, SampledMotion
from stribeck.motion.design.setting import Setting

Array = NDArray[np.float64]

#: Candidates of a generation and generations of the search, for each family of motions.
CANDIDATES, GENERATIONS = 24, 30
#: Number of samples during the search; a model with a state needs more.
FEW_SAMPLES, MORE_SAMPLES = 1200, 5000
#: Cost of a motion that does not show a wanted effect.
SHOWS_NOTHING = 1e6


def search(
    families: Sequence[Family],
    wanted: Wanted,
    setting: Setting,
    duration: float,
    rate: float,
    seed: int,
) -> tuple[str, SampledMotion]:
    """Return the best motion of all families, and the name of its family."""
    plain = all(one.problem.model.memoryless for one in wanted.widened.values())
    coarse = min(rate, (FEW_SAMPLES if plain else MORE_SAMPLES) / duration)
    found = []
    for k, family in enumerate(families):
        rng = np.random.default_rng([seed, k])
        first = rng.random((CANDIDATES, family.variables))
        first[0] = family.start

        def cost(design: Array, family: Family = family) -> float:
            value = least_information(wanted, setting, family.motion(design, coarse), coarse)
            return -value if np.isfinite(value) else SHOWS_NOTHING

        best = scipy.optimize.differential_evolution(
            cost,
            [(0.0, 1.0)] * family.variables,
            maxiter=GENERATIONS,
            init=first,
            seed=rng,
            polish=False,
            tol=1e-4,
        )
        found.append((best.fun, family, best.x))
    _, family, design = min(found, key=lambda row: row[0])
    return family.name, family.motion(design, rate)
