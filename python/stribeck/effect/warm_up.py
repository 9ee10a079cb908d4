"""Warm-up: gain and zero of the torque channel settle during the recording."""

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
from stribeck.effect.columns import hats
from stribeck.effect.drift import NO_TIME, duration, generated_duration
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.gain import motor_torque_is_not_known, needs_motor_torque
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

#: Functions of time of which a settling may be any combination.
HATS = 6


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return NO_TIME
    return motor_torque_is_not_known(facts)


def _refusal(model: Model, recording: Recording) -> str | None:
    return needs_motor_torque("warm_up", recording)


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    share, zero = m.value("warm_up"), m.value("warm_up_zero")
    settles = m.constants["duration"] / m.value("warm_up_rate")
    # A gain of the model is that at the end.
    than = ", compared with the end," if "gain" in m.effects else ""
    return (
        f"at the start the torque channel shows{than} {number(100 * abs(share))} % "
        f"{'too much' if share > 0 else 'too little'} of all torque and is shifted by "
        f"{number(zero)} {m.torque_unit}; both settle with a time constant of {number(settles)} s"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Any function of time, as shift and as gain."""
    shapes = hats(fit.recording.elapsed[fit.rows], HATS)
    return [*shapes, *(h * fit.prediction[fit.rows] for h in shapes)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"warm_up": 0.08, "warm_up_zero": 0.1 * joint.coulomb, "warm_up_rate": 4.0}


EFFECT = Effect(
    id="warm_up",
    view=ResidualView("time"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=duration,
    generated_constants=generated_duration,
    refusal=_refusal,
    flexible_shape=_flexible_shape,
    design_note=(
        "an amplifier warms up once: begin a recording when it is warm, or record until it is"
    ),
    in_motion="measurement",
    steady=("offset", "gain"),
)
