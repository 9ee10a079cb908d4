"""Saturation: the torque constant falls as the motor torque grows."""

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
from stribeck.effect.columns import odd_powers
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.gain import motor_torque_is_not_known, needs_motor_torque
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

#: Ratio of the largest torque to a small one from which a curve over torque shows, and the share of
#: the samples that have less than a small one.
TORQUE_RATIO, SMALL = 2.0, 0.1


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    if (why := motor_torque_is_not_known(facts)) is not None:
        return why
    sizes = np.abs(facts.recording.torque[facts.recording.moving])
    small, top = np.quantile(sizes, [SMALL, 0.99])
    if top >= TORQUE_RATIO * small:
        return None
    unit = facts.recording.torque_unit
    return Obstacle(
        f"all but a tenth of the samples have a torque above {number(small)} {unit}, more than "
        f"half of the largest, {number(top)} {unit}",
        "add fast accelerations or heavy payloads, up to the largest torque of the motor",
    )


def _constants(recording: Recording) -> dict[str, float]:
    top = float(np.quantile(np.abs(recording.torque[recording.moving]), 0.99))
    return {"reference_torque": top or 1.0}


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {"reference_torque": 2.0 * made.joint.gravity}


def _refusal(model: Model, recording: Recording) -> str | None:
    return needs_motor_torque("saturation", recording)


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    shown = m.constants["reference_torque"]
    share, exponent = 100 * m.value("saturation"), m.value("saturation_exponent")
    # The reference is a torque as shown; the motor delivers less.
    delivered = np.linspace(0.0, 1.0, 1001)
    top = float(np.interp(1.0, delivered * (1 + share / 100 * delivered**exponent), delivered))
    return (
        f"the torque channel shows {number(share * top**exponent)} % more than the motor delivers "
        f"at {number(shown * top)} {m.load_unit}, and "
        f"{number(share * (0.5 * top) ** exponent)} % more at half that torque"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Odd powers of the motor torque."""
    return odd_powers(fit.prediction[fit.rows], fit.model.constants["reference_torque"])


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"saturation": 0.12, "saturation_exponent": 2.0}


EFFECT = Effect(
    id="saturation",
    view=ResidualView("modelled"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=_constants,
    generated_constants=_generated_constants,
    refusal=_refusal,
    flexible_shape=_flexible_shape,
    design_note=(
        "a motion within these limits may not reach the largest torque of the motor: run it again "
        "with the heaviest payload"
    ),
    in_motion="measurement",
)
