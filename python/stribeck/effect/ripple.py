"""Ripple: a torque that repeats along the stroke, of magnets, poles or teeth."""

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
from stribeck.effect.facts import RecordingFacts
from stribeck.effect.periodogram import FEWEST_PERIODS, most_periods, strongest_period
from stribeck.effect.position import generated_ends, stroke_ends, stroke_is_not_shown
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

#: A second harmonic that is so many times larger than the first is the ripple.
DOMINANT = 3.0


def ripple_period_of(model: Model) -> float:
    """Period of the fitted ripple, in the unit of position."""
    constants = model.constants
    detuning = model.value("ripple_detuning") / constants["position_length"]
    return 1.0 / (1.0 / constants["ripple_period"] + detuning)


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    # Its periods repeat within one pass of the stroke.
    if (why := stroke_is_not_shown(facts)) is not None:
        return why
    if most_periods(facts.recording) > FEWEST_PERIODS:
        return None
    return Obstacle(
        "the samples are too far apart to show a torque that repeats along the stroke",
        "record slow passes in both directions, at a higher rate",
    )


def _constants_beside(
    recording: Recording, load: Array | None, residual: Array | None
) -> dict[str, float]:
    if recording.position is None:
        return {}
    return {"ripple_period": strongest_period(recording, residual)}


def _generated_constants(made: GeneratedRecording) -> dict[str, float]:
    return {**generated_ends(made), "ripple_period": made.joint.stroke / 7.0}


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    period = ripple_period_of(m)
    first, second = (
        float(np.hypot(m.value(f"ripple_{part}cos"), m.value(f"ripple_{part}sin")))
        for part in ("", "second_")
    )
    if second > DOMINANT * first:
        period /= 2.0
    digits = _digits(after.recording, period)
    turn = ""
    if after.recording.joint_kind == "revolute":
        turn = f" ({number(2.0 * np.pi / period, digits)} per turn)"
    return (
        f"a torque of {number(np.hypot(first, second))} {m.torque_unit} repeats every "
        f"{number(period, digits)} {m.position_unit}{turn}, the same in both directions"
    )


def _digits(recording: Recording, period: float) -> int:
    """Digits of a period that is known to a tenth over the stroke."""
    periods = 1.0 if recording.position is None else float(np.ptp(recording.position)) / period
    return 2 + max(1, round(np.log10(max(periods, 1.0))))


def _flexible_shape(fit: Identified) -> list[Array]:
    """Higher harmonics."""
    if fit.recording.position is None:
        return []
    phase = 2.0 * np.pi * fit.recording.position[fit.rows] / ripple_period_of(fit.model)
    return [wave(k * phase) for k in (3, 4) for wave in (np.cos, np.sin)]


def _forms(recording: Recording) -> int:
    """Periods from which the strongest is chosen."""
    return max(most_periods(recording), 1)


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    c = joint.coulomb
    return {
        "ripple_cos": 0.12 * c,
        "ripple_sin": 0.08 * c,
        "ripple_second_cos": 0.03 * c,
        "ripple_second_sin": 0.02 * c,
    }


EFFECT = Effect(
    id="ripple",
    view=ResidualView("phase"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants=stroke_ends,
    constants_beside=_constants_beside,
    generated_constants=_generated_constants,
    flexible_shape=_flexible_shape,
    forms=_forms,
)
