"""Surge: dry friction grows with the size of the acceleration."""

from __future__ import annotations

import numpy as np
from stribeck.effect.base import Effect, Identified, JointSizes, ResidualView, number
from stribeck.effect.inertia import hardly_accelerates


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    top = max(abs(x) for x in m.box["acceleration"])
    return (
        f"at the same speed friction is {number(m.value('surge') * top)} {m.load_unit} higher at "
        f"{number(top)} {m.position_unit}/s2 than without acceleration"
    )


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"surge": joint.inertia}


EFFECT = Effect(
    id="surge",
    view=ResidualView("acceleration", along="motion"),
    obstacle=hardly_accelerates,
    where=_where,
    plausible=_plausible,
)
