"""Quadrant: friction differs between motoring and generating."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Effect, Identified, JointSizes, Obstacle, ResidualView, number
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.load import PAYLOAD_NOTE, load_is_too_uniform

#: Share of the samples that motoring and generating each need.
QUADRANT_SHARE = 0.1


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if (why := load_is_too_uniform(facts)) is not None:
        return why
    load = facts.scored(facts.recording.load_torque)
    if load is None:
        return Obstacle(
            "the load torque is identified together with the friction, and a common scale of "
            "inertia and gravity is indistinguishable from a difference between the quadrants",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    motoring = float(np.mean(facts.velocity * load > 0))
    if not QUADRANT_SHARE <= motoring <= 1.0 - QUADRANT_SHARE:
        return Obstacle(
            f"the joint drives its load in {motoring:.0%} of the samples",
            "lift and lower the same load at the same speeds",
        )
    return None


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    most = max(abs(x) for x in m.box["load_torque"])
    speed = 0.5 * max(abs(x) for x in m.box["velocity"])
    driving, driven = (
        float(m.split(speed, load_torque=np.array([sign * most]))["dry"][0]) for sign in (1, -1)
    )
    more = "higher" if driving > driven else "lower"
    return (
        f"under {number(most)} {m.load_unit} of load at {number(speed)} {m.position_unit}/s "
        f"friction is {number(abs(driving - driven))} {m.load_unit} {more} while the joint "
        f"drives the load than while the load drives the joint"
    )


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"quadrant_coulomb": 0.1, "quadrant_viscous": 0.05 / joint.speed}


EFFECT = Effect(
    id="quadrant",
    view=ResidualView("load_along", along="motion"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    design_note=PAYLOAD_NOTE,
)
