"""Spring: a torque of position alone, such as that of a hose or a balancer."""

from __future__ import annotations

from functools import partial

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    Identified,
    JointSizes,
    ResidualView,
    number,
)
from stribeck.effect.columns import half_waves
from stribeck.effect.gravity import GRAVITY_RANGE
from stribeck.effect.load_parts import absorbed
from stribeck.effect.periodogram import FEWEST_PERIODS
from stribeck.effect.position import generated_ends, stroke_ends, stroke_is_not_repeated


def _alike(_: Identified, after: Identified) -> tuple[str, ...]:
    """Gravity, over a part of a turn in which its torque is a straight line too."""
    r = after.recording
    if r.joint_kind != "revolute" or r.position is None or "gravity" in after.model.effects:
        return ()
    return ("gravity",) if float(np.ptp(r.position[r.moving])) < GRAVITY_RANGE else ()


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
    obstacle=stroke_is_not_repeated,
    absorbed=partial(absorbed, "spring"),
    where=_where,
    plausible=_plausible,
    constants=stroke_ends,
    generated_constants=generated_ends,
    flexible_shape=_flexible_shape,
    alike=_alike,
    acts_alone=True,
)
