"""Position: dry friction varies along the stroke, in both directions alike."""

from __future__ import annotations

import math

import numpy as np

from stribeck.effect.base import (
    Array,
    Effect,
    GeneratedRecording,
    Identified,
    JointSizes,
    Obstacle,
    ResidualView,
    number,
)
from stribeck.effect.columns import half_waves
from stribeck.effect.direction import one_direction
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.free_form import of_stroke_and_speed
from stribeck.effect.load_along_stroke import friction_by_load
from stribeck.recording.recording import Recording

#: Number of times that the stroke must be passed.
FEWEST_PASSES = 2.5
#: Parameters, one for each half wave along the stroke.
WAVES = 8
#: Share of the stroke to each side of a position in which a motion passes it.
NEAR = 0.05


def stroke_is_not_shown(facts: RecordingFacts) -> Obstacle | None:
    """The position was not recorded, or does not vary in both directions."""
    q = facts.scored(facts.recording.position)
    if q is None:
        return Obstacle("no position was recorded", "record the joint's position")
    if (only := one_direction(facts)) is not None:
        return only
    if not np.ptp(q) > 0.0:
        return Obstacle("the position does not vary", "move along the stroke")
    return None


def stroke_is_not_repeated(facts: RecordingFacts) -> Obstacle | None:
    """The stroke is not shown, or not passed again in both directions."""
    if (why := stroke_is_not_shown(facts)) is not None:
        return why
    q = facts.scored(facts.recording.position)
    stroke = 0.0 if q is None else float(np.ptp(q))
    path = float(np.sum(np.abs(facts.recording.velocity) * facts.recording.dt))
    if path < FEWEST_PASSES * stroke:
        return Obstacle(
            f"the stroke is passed only {path / stroke:.1f} times",
            "pass the same stroke several times in both directions",
        )
    return None


def stroke_constants(recording: Recording) -> dict[str, float]:
    """Start, length and periodicity of the stroke."""
    if recording.position is None:
        return {}
    q = recording.position[recording.moving]
    start, length = float(q.min()), float(np.ptp(q)) or 1.0
    if recording.joint_kind == "revolute" and length > 4.0 * math.pi:
        # Beyond two turns, what varies along the stroke repeats with the turn.
        return {"position_start": 0.0, "position_length": 2.0 * math.pi, "position_periodic": 1.0}
    return {"position_start": start, "position_length": length, "position_periodic": 0.0}


def stroke_ends(recording: Recording) -> dict[str, float]:
    """Start and length of the stroke."""
    stroke = stroke_constants(recording)
    stroke.pop("position_periodic", None)
    return stroke


def generated_ends(made: GeneratedRecording) -> dict[str, float]:
    """Start and length of the stroke in a generated recording."""
    return {
        "position_start": -1.5 * made.joint.stroke,
        "position_length": 3.0 * made.joint.stroke,
    }


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {**generated_ends(made), "position_periodic": 0.0}


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    low, high = m.box["position"]
    q = np.linspace(low, high, 200)
    top = max(abs(x) for x in m.box["velocity"])
    dry = m.split(top, position=q)["dry"]
    at = float(q[int(np.argmax(dry))])
    said = (
        f"dry friction varies by {number(float(np.ptp(dry)))} {m.load_unit} along the stroke and "
        f"is highest at {number(at)} {m.position_unit}, {_ways(after, at, NEAR * (high - low))}"
    )
    for_each = _for_each_load(before, after)
    if for_each is None:
        return said
    return (
        f"{said}. It follows the load torque along the stroke, {number(for_each)} {m.torque_unit} "
        f"for each {m.load_unit} of it: record the motion with another payload to tell"
    )


def _ways(after: Identified, at: float, near: float) -> str:
    """In which directions the joint moves within `near` of a position."""
    r = after.recording
    assert r.position is not None
    there = np.abs(r.position[after.rows] - at) <= near
    ways = np.sign(r.velocity[after.rows])[there]
    forward, backward = bool(np.any(ways > 0.0)), bool(np.any(ways < 0.0))
    if forward is backward:
        return "in both directions"
    return f"where this motion is {'forward' if forward else 'backward'} only"


def _for_each_load(before: Identified, after: Identified) -> float | None:
    """Dry friction for each unit of load torque, where it may be due to that."""
    return None if "load" in before.model.effects else friction_by_load(after)


def _alike(before: Identified, after: Identified) -> tuple[str, ...]:
    """Friction that follows the load torque along the stroke may be due to that."""
    return () if _for_each_load(before, after) is None else ("load",)


def _flexible_shape(fit: Identified) -> list[Array]:
    """Finer waves along the stroke."""
    if fit.recording.position is None:
        return []
    sign = np.sign(fit.recording.velocity[fit.rows])
    return [sign * wave for wave in half_waves(fit.recording.position[fit.rows], range(1, 15))]


def _plausible(joint: JointSizes, random: np.random.Generator) -> dict[str, float]:
    """Any shape, with less of the shorter waves."""
    most = 0.22 * joint.coulomb
    return {
        f"position_{k}": float(most * random.uniform(-1.0, 1.0) / k) for k in range(1, WAVES + 1)
    }


EFFECT = Effect(
    id="position",
    view=ResidualView("position", along="motion"),
    obstacle=stroke_is_not_repeated,
    where=_where,
    plausible=_plausible,
    constants=stroke_constants,
    generated_constants=_generated_constants,
    series=True,
    flexible_shape=_flexible_shape,
    free_form=of_stroke_and_speed(WAVES),
    alike=_alike,
)
