"""Gravity: the load torque assumes a wrong weight or centre of mass."""

from __future__ import annotations

from functools import partial

import numpy as np
import scipy

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
from stribeck.effect.load_parts import absorbed, alike

#: Range of a revolute joint in rad below which gravity is indistinguishable from an offset.
GRAVITY_RANGE = 0.3
#: Intervals of the angle, of equally many samples, over which a torque of position is averaged.
INTERVALS = 40


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


def _alike(fit: Identified) -> tuple[str, ...]:
    """A spring, where a torque that only rises or only falls with the angle leaves no more."""
    q, torque, m = fit.recording.position, fit.recording.torque, fit.model
    if q is None or torque is None or "spring" in m.effects:
        return ()
    angle, residual = q[fit.rows], (torque - fit.prediction)[fit.rows]
    weight = m.value("gravity_cos") * np.cos(angle) + m.value("gravity_sin") * np.sin(angle)
    parts = np.array_split(np.argsort(angle), min(INTERVALS, angle.size))
    left, curve = (np.array([x[part].mean() for part in parts]) for x in (residual, weight))
    for rising in (True, False):
        smooth = scipy.optimize.isotonic_regression(curve + left, increasing=rising).x
        if np.sum((curve + left - smooth) ** 2) <= np.sum(left**2):
            return ("spring",)
    return ()


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
    fixed_form=FixedForm("position", _functions_of_position, _alike),
    absorbed=partial(absorbed, "gravity"),
    alike=partial(alike, "gravity"),
)
