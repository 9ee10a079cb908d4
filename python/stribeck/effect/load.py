"""Load: dry friction grows with the load torque."""

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
from stribeck.effect.facts import RecordingFacts, spread
from stribeck.recording.recording import Recording

#: Relative spread of the load from which a dependence on it shows.
LOAD_SPREAD = 0.1
#: Share of the samples in which velocity and load must have the same sign, and the opposite one.
BOTH_SIGNS = 0.02

#: What to say where the load torque is needed but neither recorded nor identified.
UNKNOWN_LOAD = Obstacle(
    "the load torque is not known",
    "record load_torque, or a motion that shows inertia and gravity",
)
#: More about a planned motion, for all effects that need different payloads.
PAYLOAD_NOTE = (
    "inertia and gravity alone vary the load here: run the motion again with another payload of "
    "known mass, to show smaller effects and to separate them from a dependence on position"
)


def load_is_too_uniform(facts: RecordingFacts) -> Obstacle | None:
    """The load torque is unknown, hardly varies, or always has the same sign as the velocity."""
    if facts.load is None:
        return UNKNOWN_LOAD
    load = facts.load[facts.recording.moving]
    size = np.abs(load)
    torque = facts.recording.torque[facts.recording.moving]
    scale = float(np.sqrt(np.mean(torque**2))) or 1.0
    if spread(size) < LOAD_SPREAD * max(scale, float(np.quantile(size, 0.99))):
        return Obstacle(
            "the load torque varies too little",
            "repeat the motion in other poses or with other payloads",
        )
    share = float(np.mean(np.sign(facts.velocity) * load > 0))
    if not BOTH_SIGNS <= share <= 1.0 - BOTH_SIGNS:
        return Obstacle(
            "the load torque always has the same sign relative to the velocity, so load-dependent "
            "friction is indistinguishable from an error of gravity or inertia",
            "move up and down under the same load",
        )
    return None


def _constants(recording: Recording) -> dict[str, float]:
    return _reference(recording, recording.load_torque)


def _constants_beside(
    recording: Recording, load: Array | None, residual: Array | None
) -> dict[str, float]:
    if load is None:
        return {}
    return _reference(recording, load if recording.load_torque is None else recording.load_torque)


def _reference(recording: Recording, load: Array | None) -> dict[str, float]:
    size = 0.0 if load is None else float(np.sqrt(np.mean(load[recording.moving] ** 2)))
    return {"reference_load": size or 1.0}


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    most = max(abs(x) for x in m.box["load_torque"])
    reference = m.constants["reference_load"]
    part = m.value("load_coulomb") * reference * (most / reference) ** m.value("load_exponent")
    return (
        f"at the same speed friction is {number(part)} {m.load_unit} higher under "
        f"{number(most)} {m.load_unit} of load than without load"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Any function of the size of the load."""
    r = fit.recording
    load = r.load_torque if r.load_torque is not None else fit.load
    if load is None:
        return []
    sign = np.sign(r.velocity[fit.rows])
    return [sign * h for h in hats(np.abs(load[fit.rows]), 7)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"load_coulomb": 0.16, "load_exponent": 1.0, "load_stribeck": 0.0}


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {"reference_load": 0.5 * made.joint.gravity}


EFFECT = Effect(
    id="load",
    view=ResidualView("load_size", along="motion"),
    obstacle=load_is_too_uniform,
    where=_where,
    plausible=_plausible,
    constants=_constants,
    constants_beside=_constants_beside,
    generated_constants=_generated_constants,
    flexible_shape=_flexible_shape,
    design_note=PAYLOAD_NOTE,
)
