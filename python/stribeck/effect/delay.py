"""Delay: the torque channel is late or early against the motion."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Effect, Identified, JointSizes, Obstacle, ResidualView, number
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.inertia import hardly_accelerates
from stribeck.recording.motion.velocity_lag import recorded_lag

#: Largest ratio of a delay to the lag of the velocity that explains it: a filter acts most on the
#: fast motions that show a delay.
ALIKE = 2.0


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if facts.recording.averaged:
        return Obstacle("steady-state points contain no timing", "record accelerated motion")
    return hardly_accelerates(facts)


def _where(before: Identified, after: Identified) -> str:
    tau = after.model.value("delay")
    said = (
        f"the torque {_way(tau)} the motion by {number(1e3 * abs(tau))} ms "
        f"({number(abs(tau) * after.recording.rate_hz)} samples)"
    )
    velocity = after.recording.velocity[after.recording.moving]
    if velocity.min() < 0.0 < velocity.max():
        said = f"{said}, most visible at reversals"
    late = recorded_lag(after.recording)
    if late is None or not late.exceeds(abs(tau) / ALIKE):
        return said
    said = (
        f"{said}; the velocity is {number(1e3 * late.lag)} ms behind the position, as behind a "
        "filter"
    )
    if tau < 0.0 and late.lag <= -tau * ALIKE:
        return f"{said}, which explains it"
    behind = late.lag + tau
    return f"{said}; the torque {_way(behind)} the position by {number(1e3 * abs(behind))} ms"


def _way(tau: float) -> str:
    return "lags behind" if tau > 0 else "leads"


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
