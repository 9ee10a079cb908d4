"""Elasticity: the drive train twists under the load torque."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import option
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
from stribeck.effect.hardening import LARGE, detailed_resonance
from stribeck.effect.resonance import NONE, resonances
from stribeck.models.model import Model
from stribeck.models.parameter import joint_unit
from stribeck.recording.derive import Smoother
from stribeck.recording.motion.derived_motion import cutoff_of
from stribeck.recording.motion.spring_torque import Resonance
from stribeck.recording.recording import Recording
from stribeck.recording.rows import noise_level

#: A drive train that resonates at a lower frequency shows in any joint, Hz.
SOFT_DRIVE = 5.0
#: Least torque that such a drive train must show, as shares of the load torque and of the noise:
#: ten thousand samples or more show a fiftieth of their noise.
TWIST_SHARE, TWIST_NOISE = 1e-3, 0.02
#: A resonance of fewer samples a period may be what differences between samples lack.
FEWEST_RESOLVED = 6.0
#: Share of the cut-off of a derived acceleration up to which that is known.
KNOWN = 0.75
#: Periods of other resonances that the form of one includes, as multiples.
NEAR = (0.8, 1.25)


def _obstacle(facts: RecordingFacts) -> Obstacle | None:
    r = facts.recording
    if r.averaged:
        return Obstacle(
            "steady motion contains no change of the load torque", "record accelerated motion"
        )
    curvature, load = facts.scored(r.load_torque_curvature), facts.scored(r.load_torque)
    if curvature is None or load is None:
        return Obstacle(
            "the load torque is not known beforehand, nor the positions on both sides of the drive "
            "train",
            "give the load torque, or inertia and gravity from a weighing or a CAD model",
        )
    # Quantiles: the exchange of a payload is not motion.
    size = float(np.quantile(np.abs(load - np.median(load)), 0.9))
    twist = float(np.quantile(np.abs(curvature), 0.9)) / (2.0 * np.pi * SOFT_DRIVE) ** 2
    noise = noise_level(r.time, r.torque, r.segment)
    if twist > max(TWIST_SHARE * size, TWIST_NOISE * noise):
        return None
    return Obstacle(
        f"the load torque changes so slowly that even a drive train that resonates at "
        f"{SOFT_DRIVE:.0f} Hz would look rigid",
        "add motions that start and stop abruptly, or record positions at motor and joint",
    )


def _constants_beside(
    recording: Recording, _: Array | None, residual: Array | None
) -> dict[str, float]:
    return detailed_resonance(recording, residual).constants


def _generated_constants(_: GeneratedRecording) -> dict[str, float]:
    return NONE.constants


def _forms(recording: Recording) -> int:
    """Resonances from which the best is chosen, and none."""
    return 1 + len(resonances(recording))


def _refusal(model: Model, recording: Recording) -> str | None:
    if recording.load_torque is not None:
        return None
    return (
        f"elasticity needs a load_torque that is known beforehand, which {recording.path} does "
        f"not have: map one with {option('map', 'load_torque=COLUMN')}, or leave the effect out"
    )


def _where(before: Identified, after: Identified) -> str:
    doubt = _beyond_band(after)
    return f"{_shape_of(after)}{'' if doubt is None else f'; {doubt}'}"


def _shape_of(after: Identified) -> str:
    share, resonance = after.model.value("elasticity"), _resonance(after)
    if resonance.period > 0.0:
        carried = -share * (2.0 * np.pi / resonance.period) ** 2
        return (
            f"the residual oscillates as if {number(100.0 * carried, 2)} % of the load torque"
            f"{_beyond_motor(after, resonance)} drove an inertia on a drive train that resonates "
            f"at {number(_frequency(after))} Hz with "
            f"{number(100.0 * resonance.damping, 2)} % of critical damping"
            f"{_hardening(after, resonance)}"
        )
    side = "motor" if share > 0 else "joint"
    return (
        f"the residual follows the second derivative of the load torque, as if the inertia of the "
        f"{side} oscillated on the drive train at {number(_frequency(after))} Hz{_smoothed(share)}"
    )


def _resonance(fit: Identified) -> Resonance:
    return Resonance.of(fit.model.core.constants)


def _beyond_motor(after: Identified, resonance: Resonance) -> str:
    """The inertia of the load torque that does not oscillate, as words after it."""
    if not resonance.motor_inertia > 0.0:
        return ""
    unit = joint_unit("T s2/X", after.model.load_unit, after.model.position_unit)
    return f", without the {number(resonance.motor_inertia)} {unit} of the motor,"


def _hardening(after: Identified, resonance: Resonance) -> str:
    """How much a spring hardens under the load torque, as a clause."""
    load = after.recording.load_torque
    if not resonance.hardening > 0.0 or load is None:
        return ""
    size = float(np.quantile(np.abs(load[after.rows]), LARGE))
    # The root of y + y^3/h^2 = size.
    third = np.arcsinh(1.5 * np.sqrt(3.0) * size / resonance.hardening) / 3.0
    twist = 2.0 / np.sqrt(3.0) * resonance.hardening * float(np.sinh(third))
    return (
        f"; its spring hardens: under {number(size)} {after.model.load_unit} it twists "
        f"{number(100.0 * (1.0 - twist / size), 2)} % less than a linear one"
    )


def _smoothed(share: float) -> str:
    """The smoothing of the load torque that looks the same, as a clause; none takes this sign.

    A moving average over the time T takes T^2/24 of the second derivative away.
    """
    if share >= 0.0:
        return ""
    return (
        f"; a load torque averaged over {number(float(np.sqrt(-24.0 * share)), 2)} s does the same"
    )


def _unresolved(after: Identified) -> str | None:
    """Differences between samples smooth: taken twice, they lack dt^2/3 of the second derivative.

    A drive train that twists under the inertia of the motor has the other sign.
    """
    share, period = after.model.value("elasticity"), after.recording.scales()["sample_period"]
    if _resonance(after).period > FEWEST_RESOLVED * period:
        return None
    if not -(period**2) <= share < 0.0:
        return None
    return (
        f"the drive train would oscillate at {number(_frequency(after))} Hz, and a load torque "
        f"from differences between samples is off by as much"
    )


def _frequency(after: Identified) -> float:
    """At which the drive train oscillates, Hz."""
    period, share = _resonance(after).period, after.model.value("elasticity")
    own = 2.0 * np.pi * np.sqrt(max(abs(share), np.finfo(float).tiny))
    return float(1.0 / (period if period > 0.0 else own))


def _beyond_band(after: Identified) -> str | None:
    """A load torque behind a low-pass lacks what a drive train adds near its resonance.

    The motion tells them apart below the low-pass of its own acceleration.
    """
    r = after.recording
    highest = cutoff_of(r) if r.columns["acceleration"].derived else None
    if highest is None or _frequency(after) < KNOWN * highest:
        return None
    return (
        f"the acceleration is known up to {number(highest)} Hz, and a load torque behind a "
        f"low-pass near that does the same"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Damping of the twist, the share of the motor's inertia, and resonances that are near."""
    r, own = fit.recording, _resonance(fit)
    if r.load_torque is None:
        return []
    others = [replace(own, period=by * own.period) for by in NEAR if own.period > 0.0]
    near = [other.curvature(r) for other in others]
    smoother = Smoother(r.time, r.segment, None)
    rate = smoother.smooth(r.denoised("load_torque"), 1)
    motor = smoother.smooth(r.acceleration_smooth, 2)
    return [x[fit.rows] for x in (rate, motor, *near) if x is not None]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"elasticity": 0.002 * (joint.stroke / joint.speed) ** 2}


EFFECT = Effect(
    id="elasticity",
    view=ResidualView("load_curvature"),
    obstacle=_obstacle,
    where=_where,
    plausible=_plausible,
    constants_beside=_constants_beside,
    generated_constants=_generated_constants,
    refusal=_refusal,
    flexible_shape=_flexible_shape,
    forms=_forms,
    unresolved=_unresolved,
    beyond_band=_beyond_band,
    design_note=(
        "a motion at one end of the drive train shows its twist only where the load torque changes "
        "fast: record the positions at motor and joint as well"
    ),
    in_motion="drive train",
)
