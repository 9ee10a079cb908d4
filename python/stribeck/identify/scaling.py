"""Fit a model's bounds, starts and constants to the scales of a recording.

The catalog states bounds as multiples of what the recording shows (its largest speed, its
torque ...), so that nothing depends on the size of the machine or on units.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.errors import FitError
from stribeck.model import RIGID_BODY_EFFECTS, Model, Parameter, parse_spec
from stribeck.recording import Recording
from stribeck.servo.scaling import drive_scales, known_constants

Array = NDArray[np.float64]


def scale_values(recording: Recording) -> dict[str, float]:
    """The size of one unit of each of the catalog's scales, on this recording."""
    s = recording.scales()
    torque = s["torque"] or 1.0
    speed = s["speed"] or 1.0
    position = s["position"] or 1.0
    acceleration = s["acceleration"] or 1.0
    return {
        "none": 1.0,
        "speed": speed,
        "position": position,
        "torque": torque,
        "stiffness": torque / position,
        "damping": torque / speed,
        "square_damping": torque / speed**2,
        "cubic_damping": torque / speed**3,
        "root_damping": torque / math.sqrt(speed),
        "inverse_speed": 1.0 / speed,
        "inverse_torque": 1.0 / torque,
        "inertia": torque / acceleration,
        "torque_rate": torque * speed / position,
        "sample_period": s["sample_period"] or 1.0,
        **drive_scales(recording),
    }


def scaled_parameters(model: Model, recording: Recording) -> tuple[Parameter, ...]:
    """The model's parameters with bounds and starts in their own units."""
    scales = scale_values(recording)
    return tuple(
        replace(
            p,
            lower=p.lower * scales[p.scale],
            upper=p.upper * scales[p.scale],
            start=p.start * scales[p.scale],
        )
        for p in model.parameters
    )


def bounds(model: Model, recording: Recording) -> tuple[Array, Array, Array]:
    """Lower bounds, upper bounds and starts, arrays [p]."""
    rows = scaled_parameters(model, recording)
    lower = np.array([p.lower for p in rows])
    upper = np.array([p.upper for p in rows])
    start = np.array([p.start for p in rows])
    return lower, upper, start


def effect_constants(
    effect: str, recording: Recording, load: Array | None = None
) -> dict[str, float]:
    """The constants that an effect needs, taken from the recording."""
    moving = recording.moving
    if effect in ("temperature_viscous", "temperature_dry"):
        if recording.temperature is None:
            return {}
        return {"reference_temperature": float(np.mean(recording.temperature[moving]))}
    if effect == "load":
        tl = recording.load_torque if recording.load_torque is not None else load
        size = 0.0 if tl is None else float(np.sqrt(np.mean(tl[moving] ** 2)))
        return {"reference_load": size or 1.0}
    if effect == "nonlinear_viscous":
        return {"reference_velocity": recording.scales()["speed"] or 1.0}
    if effect == "position":
        if recording.position is None:
            return {}
        q = recording.position[moving]
        start, length = float(q.min()), float(np.ptp(q)) or 1.0
        if recording.joint_kind == "revolute" and length > 4.0 * math.pi:
            # More than two turns: what varies along the stroke repeats with the turn.
            return {
                "position_start": 0.0,
                "position_length": 2.0 * math.pi,
                "position_periodic": 1.0,
            }
        return {"position_start": start, "position_length": length, "position_periodic": 0.0}
    return {}


def rigid_body_terms(recording: Recording, effects: tuple[str, ...]) -> tuple[str, ...]:
    """Which rigid-body terms must be identified with the friction on this recording."""
    if recording.load_torque is not None or recording.averaged:
        return ()
    terms = []
    for term in RIGID_BODY_EFFECTS:
        if term in effects:
            continue
        if term == "inertia" and recording.acceleration is None:
            continue
        if term == "gravity" and (recording.joint_kind != "revolute" or recording.position is None):
            continue
        terms.append(term)
    return tuple(terms)


def model_for(spec: str | Model, recording: Recording) -> Model:
    """A model of `spec` with units, constants and rigid-body terms for this recording."""
    if isinstance(spec, Model):
        law, effects, constants = spec.law, spec.effects, dict(spec.constants)
    else:
        law, effects = parse_spec(spec)
        constants = {}
    for effect in effects:
        needed = effect_constants(effect, recording)
        constants = {**needed, **constants}
    constants.update(known_constants(recording))
    made = Model(
        law=law,
        effects=effects,
        constants=constants,
        rigid_body=rigid_body_terms(recording, effects),
        torque_unit=recording.torque_unit,
        position_unit=recording.position_unit,
        drive=recording.drive,
    )
    check_channels(made, recording)
    if isinstance(spec, Model):
        known = dict(zip(spec.names, spec.values, strict=True))
        made = made.with_values([known.get(name, np.nan) for name in made.names])
    return made


def check_channels(model: Model, recording: Recording) -> None:
    """Refuse a model that needs a channel which the recording does not have."""
    if model.drive != recording.drive:
        raise FitError(
            f"the model {model.spec} predicts {_effort(model.drive)}, but {recording.path} is read "
            f"as {_effort(recording.drive)}: "
            + ("leave --drive out" if model.drive is None else f"give --drive {model.drive}")
        )
    for channel in model.core.needs:
        if channel == "load_torque" and model.rigid_body:
            continue
        if channel == "external_torque" and "gravity" in model.rigid_body:
            continue
        if channel == "motor_torque":
            # It is what a fit predicts: it follows from the balance of all torques.
            if model.has_state:
                raise FitError(
                    f"friction of {model.spec} depends on the motor torque, which cannot be solved "
                    "for in a model with a memory: leave presliding out"
                )
            continue
        if channel == "external_torque" and recording.external_torque is None:
            raise FitError(
                f"{model.spec} needs the torque of the environment, which {recording.path} does "
                "not have: give inertia and gravity_cos, gravity_sin in the sidecar, or map a "
                "column with --map external_torque=COLUMN"
            )
        if getattr(recording, channel, None) is None:
            raise FitError(
                f"{model.spec} needs the column {channel}, which {recording.path} does not have: "
                f"map one with --map {channel}=COLUMN, or leave the effect out"
            )


def _effort(drive: str | None) -> str:
    return "a torque" if drive is None else f"the {drive} on a motor"
