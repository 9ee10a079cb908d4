"""Drift: dry friction changes over the recording, by wear or run-in."""

from __future__ import annotations

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
from stribeck.effect.columns import hats
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.thermal import one_way
from stribeck.recording.recording import Recording

#: What to say of averaged points where the time is needed.
NO_TIME = Obstacle(
    "steady-state points do not say when they were measured",
    "record the same motion again and again",
)


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    r = facts.recording
    if r.averaged:
        return NO_TIME
    way = one_way(r)
    if way is None:
        return None
    return Obstacle(
        f"the joint only {way}, so that time is indistinguishable from temperature",
        "let the joint cool down and warm up again",
    )


def duration(recording: Recording) -> dict[str, float]:
    """The constant `duration` of effects that change with time, s."""
    return {"duration": float(recording.elapsed[-1]) or 1.0}


def generated_duration(made: GeneratedRecording) -> dict[str, float]:
    """The same in a generated recording."""
    return {"duration": made.seconds}


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    end = m.constants["duration"]
    top = max(abs(x) for x in m.box["velocity"])
    first, last = m.split(top, time=np.array([0.0, end]))["dry"]
    way = "falls" if last < first else "rises"
    said = (
        f"dry friction {way} from {number(float(first))} to {number(float(last))} {m.torque_unit} "
        f"over the {number(end)} s of the recording, "
    )
    if after.recording.temperature is None:
        return f"{said}by wear or by temperature: record the temperature to tell"
    return f"{said}more than temperature explains"


def _alike(_: Identified, after: Identified) -> tuple[str, ...]:
    """Without a thermometer, temperature changes dry friction as slowly as time."""
    return () if after.recording.temperature is not None else ("temperature_dry",)


def _flexible_shape(fit: Identified) -> list[Array]:
    """Any function of time."""
    sign = np.sign(fit.recording.velocity[fit.rows])
    return [sign * h for h in hats(fit.recording.elapsed[fit.rows], 6)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"drift_change": -0.25, "drift_curvature": 3.0}


EFFECT = Effect(
    id="drift",
    view=ResidualView("time", along="motion"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=duration,
    generated_constants=generated_duration,
    flexible_shape=_flexible_shape,
    alike=_alike,
    design_note=(
        "wear and run-in take hours: run the motion again and again over a shift, and record the "
        "temperature; the figures are for a change within one run"
    ),
)
