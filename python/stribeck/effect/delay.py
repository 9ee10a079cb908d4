"""Delay: the torque channel is late or early against the motion."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Effect, Identified, JointSizes, Obstacle, ResidualView, number
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.inertia import hardly_accelerates


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return Obstacle("steady-state points contain no timing", "record accelerated motion")
    return hardly_accelerates(facts)


def _where(before: Identified, after: Identified) -> str:
    tau = after.model.value("delay")
    way = "lags behind" if tau > 0 else "leads"
    samples = abs(tau) * after.recording.rate_hz
    return (
        f"the torque {way} the motion by {number(1e3 * abs(tau))} ms ({number(samples)} samples), "
        f"most visible at reversals"
    )


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    # Generated data is delayed by sampling the joint at another time, not by the model.
    return {}


EFFECT = Effect(
    id="delay",
    view=ResidualView("modelled_rate", regime="sliding"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    design_note=("no motion tells which channel is late: compare with a common trigger or clock"),
    in_motion="measurement",
)
