"""Direction: friction differs between forward and backward motion."""

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
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.free_form import OF_VELOCITY


def one_direction(facts: RecordingFacts) -> Obstacle | None:
    """The joint moves in one direction only."""
    if facts.both_directions:
        return None
    way = "forward" if facts.forward > 0.5 else "backward"
    return Obstacle(
        f"all scored samples move {way}", "move in both directions over the same stroke"
    )


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    top = max(abs(x) for x in m.box["velocity"])
    slope = m.value("direction_viscous")
    base = m.value("direction_coulomb") if "direction_coulomb" in m.names else 0.0
    fast = base + slope * top
    first = f"{number(2 * abs(base))} {m.load_unit} near rest"
    if base * fast < 0.0:
        first += f", larger {_way(base)},"
    return (
        f"friction in the two directions differs by {first} and by {number(2 * abs(fast))} "
        f"{m.load_unit} at {number(top)} {m.position_unit}/s, larger {_way(fast)}"
    )


def _way(difference: float) -> str:
    return "forward" if difference > 0.0 else "backward"


def _flexible_shape(fit: Identified) -> list[Array]:
    """Powers of the speed, the same sign in both directions."""
    speed = np.abs(fit.recording.velocity[fit.rows]) / (fit.recording.scales()["speed"] or 1.0)
    return [speed**power for power in (0.5, 2.0, 3.0)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"direction_coulomb": 0.15 * joint.coulomb, "direction_viscous": 0.15 * joint.viscous}


EFFECT = Effect(
    id="direction",
    view=ResidualView("velocity"),
    obstacle=one_direction,
    where=_where,
    plausible=_plausible,
    flexible_shape=_flexible_shape,
    free_form=OF_VELOCITY,
)
