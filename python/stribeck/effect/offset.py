"""Offset: a constant error of the torque channel."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Effect, Identified, JointSizes, ResidualView, number
from stribeck.effect.direction import one_direction


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    elsewhere = ", or the spring is at rest elsewhere" if "spring" in m.effects else ""
    return (
        f"the torque is shifted by {number(m.value('offset'))} {m.load_unit}, the same in both "
        f"directions, as if Coulomb friction were larger by that in one direction and smaller in "
        f"the other{elsewhere}"
    )


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"offset": 0.12 * joint.coulomb}


EFFECT = Effect(
    id="offset",
    view=ResidualView("velocity"),
    obstacle=one_direction,
    where=_where,
    plausible=_plausible,
    # A difference between the directions that does not depend on speed is an offset.
    part_of="direction",
)
