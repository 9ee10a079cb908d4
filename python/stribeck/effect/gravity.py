"""Gravity: the load torque assumes a wrong weight or centre of mass."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    FixedForm,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import half_waves
from stribeck.effect.facts import RecordingFacts

#: Range of a revolute joint in rad below which gravity is indistinguishable from an offset.
GRAVITY_RANGE = 0.3


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.joint_kind == "prismatic":
        return Obstacle(
            "on a prismatic joint gravity is constant and indistinguishable from an offset",
            "tilt the axis, or compare with the axis level",
        )
    q = facts.scored(facts.recording.position)
    if q is None:
        return Obstacle("no position was recorded", "record the joint's position")
    if float(np.ptp(q)) < GRAVITY_RANGE:
        return Obstacle(
            f"the joint moves through only {np.ptp(q):.2g} rad, where gravity is "
            "indistinguishable from an offset",
            "move through at least a quarter of a turn",
        )
    return None


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    size = float(np.hypot(m.value("gravity_cos"), m.value("gravity_sin")))
    return (
        f"the residual varies with the angle as the torque of a weight of {number(size)} "
        f"{m.load_unit} that the load torque does not contain"
    )


def _functions_of_position(fit: Identified) -> list[Array]:
    q = fit.recording.position
    return [] if q is None else half_waves(q[fit.rows], range(1, 8))


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"gravity_cos": 0.12 * joint.gravity, "gravity_sin": 0.08 * joint.gravity}


EFFECT = Effect(
    id="gravity",
    view=ResidualView("position"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    fixed_form=FixedForm("position", _functions_of_position),
)
