"""Spring: a torque of position alone, such as that of a hose or a balancer."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import half_waves
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.gravity import GRAVITY_RANGE
from stribeck.effect.periodogram import FEWEST_PERIODS
from stribeck.effect.position import generated_ends, stroke_ends, stroke_is_not_repeated


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if (why := stroke_is_not_repeated(facts)) is not None:
        return why
    q = facts.scored(facts.recording.position)
    assert q is not None
    if facts.recording.joint_kind == "revolute" and float(np.ptp(q)) < GRAVITY_RANGE:
        return Obstacle(
            f"the joint moves through only {np.ptp(q):.2g} rad, where a spring is "
            "indistinguishable from the slope of gravity",
            "move through at least a quarter of a turn",
        )
    return None


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    low, high = m.box["position"]
    q = np.linspace(low, high, 2000)
    u = 2.0 * (q - m.constants["position_start"]) / m.constants["position_length"] - 1.0
    terms = [m.value(name) for name in ("spring_linear", "spring_quadratic", "spring_cubic")]
    size = np.ptp(np.polynomial.legendre.legval(u, [0.0, *terms]))
    return (
        f"the residual is a torque of position alone, the same in both directions, that varies by "
        f"{number(float(size))} {m.torque_unit} between {number(low)} and {number(high)} "
        f"{m.position_unit}"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Waves longer than a ripple, and a constant: the rest position of the spring is unknown."""
    q = fit.recording.position
    return [] if q is None else half_waves(q[fit.rows], range(2 * FEWEST_PERIODS))


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    c = joint.coulomb
    return {"spring_linear": 0.3 * c, "spring_quadratic": 0.05 * c, "spring_cubic": 0.1 * c}


EFFECT = Effect(
    id="spring",
    view=ResidualView("position"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=stroke_ends,
    generated_constants=generated_ends,
    series=True,
    flexible_shape=_flexible_shape,
)
