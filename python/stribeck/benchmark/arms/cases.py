"""What is hidden in the arms of the benchmark."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil

import numpy as np

from stribeck.base.errors import StribeckError, nearest

#: Effects of friction that are hidden in one joint; the base model has an offset already.
EFFECTS = (
    "stribeck",
    "nonlinear_viscous",
    "direction",
    "load",
    "quadrant",
    "temperature_viscous",
    "temperature_dry",
    "presliding",
    "position",
    "ripple",
    "drift",
    "saturation",
    "delay",
)
#: Causes in the rigid bodies, and what is right to say of each; None: base parameters absorb it.
RIGID = {
    "payload": "payload",
    "payload_centre": "payload",
    "cable": "spring",
    "link_centre": None,
}
#: Arms without anything hidden, per seed.
NONE_PER_SEED = 3
#: Arms of which intervals are checked, per seed.
COVERAGE_PER_SEED = 4
JOINTS = 6
#: Smaller seeds are used by the tests.
FIRST_SEED = 100_000


@dataclass(frozen=True)
class ArmCase:
    """One arm of the benchmark.

    Attributes
    ----------
    group : {"effect", "rigid", "none", "coverage"}
    hidden
        Effect of one joint, or cause in the rigid bodies; empty: nothing.
    joint
        Number of the joint with it, from 1; 0: not of one joint.
    """

    group: str
    hidden: str
    joint: int
    seed: int

    @property
    def name(self) -> str:
        """A unique name."""
        where = f"-{self.joint}" if self.joint else ""
        return f"{self.group}{'-' if self.hidden else ''}{self.hidden}{where}-{self.seed}"


def arm_cases(
    seeds: int = 10, *, share: float = 1.0, only: str | None = None, seed: int = 0
) -> list[ArmCase]:
    """The arms to simulate.

    Parameters
    ----------
    seeds
        Arms with each thing hidden.
    share
        Of the arms of each kind, drawn by `seed`; at least one of each.
    only
        A group, or what is hidden.

    Raises
    ------
    StribeckError
        No arm has `only`.
    """
    every = list(_kinds(seeds, FIRST_SEED + 1_000_000 * seed))
    random = np.random.default_rng(seed)
    made = []
    for kind in every:
        kept = np.sort(random.permutation(len(kind))[: ceil(share * len(kind))])
        made += [kind[k] for k in kept]
    if only is None:
        return made
    found = [case for case in made if only in (case.group, case.hidden)]
    if not found:
        names = ["effect", "rigid", "none", "coverage", *EFFECTS, *RIGID]
        raise StribeckError(
            f"no arm has {only!r}{nearest(only, names)}; there are {', '.join(names)}"
        )
    return found


def _kinds(seeds: int, first: int) -> Iterator[list[ArmCase]]:
    """The arms of each kind. The joint follows the seed, so that every joint has every effect."""
    for number, effect in enumerate(EFFECTS):
        yield [
            ArmCase("effect", effect, 1 + (number + k) % JOINTS, first + 1000 * number + k)
            for k in range(seeds)
        ]
    first += 1000 * len(EFFECTS)
    for number, cause in enumerate(RIGID):
        # A cable is not seen at the first joint only.
        joints = [1 + k % JOINTS if cause in ("cable", "link_centre") else 0 for k in range(seeds)]
        yield [ArmCase("rigid", cause, j, first + 1000 * number + k) for k, j in enumerate(joints)]
    first += 1000 * len(RIGID)
    for group, count in (("none", NONE_PER_SEED), ("coverage", COVERAGE_PER_SEED)):
        yield [ArmCase(group, "", 0, first + k) for k in range(count * seeds)]
        first += 10_000
