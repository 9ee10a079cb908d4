"""Fit a model's bounds, starts and constants to the scales of a recording.

The catalog states bounds as multiples of what the recording shows (its largest speed, its
torque ...), so that nothing depends on the size of the machine or on units.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.dimensions import CHANNELS, natural_size
from stribeck.base.errors import FitError
from stribeck.effect.constants import effect_constants
from stribeck.effect.registry import of_catalog
from stribeck.identify.drive_scaling import drive_scales, known_constants
from stribeck.identify.problem import SIGN_OF_MOTOR_TORQUE
from stribeck.models.build import law as formula_law
from stribeck.models.build import model
from stribeck.models.catalog import law_row
from stribeck.models.formula_law import is_formula
from stribeck.models.model import RIGID_BODY_EFFECTS, Model
from stribeck.models.parameter import Parameter
from stribeck.recording.recording import Recording

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
        "time": speed / acceleration,
        "square_time": (speed / acceleration) ** 2,
        "sample_period": s["sample_period"] or 1.0,
        **drive_scales(recording),
    }


def scaled_parameters(model: Model, recording: Recording) -> tuple[Parameter, ...]:
    """The model's parameters with bounds and starts in their own units.

    Bounds that were said win (`Model.limits`). A parameter that the catalog holds has its known
    value, or its start, for both bounds.
    """
    scales = scale_values(recording)
    made = []
    for p, value in zip(model.parameters, model.values, strict=True):
        scale = scales[p.scale]
        start = _formula_start(p, recording) if math.isnan(p.start) else p.start * scale
        lower, upper = p.lower * scale, p.upper * scale
        if p.name in model.limits:
            lower, upper = model.limits[p.name]
        elif p.role == "held":
            lower = upper = float(value) if math.isfinite(value) else start
        start = min(max(start, lower), upper)
        made.append(replace(p, lower=lower, upper=upper, start=start))
    return tuple(made)


def _formula_start(parameter: Parameter, recording: Recording) -> float:
    """A start for a formula's parameter of which none is said: the size that its unit has here.

    A speed starts a tenth below the largest one, where a Stribeck curve or a smoothed sign bends.
    """
    if parameter.dimension is None:
        return 1.0
    share = 0.1 if parameter.dimension == CHANNELS["velocity"] else 1.0
    return share * natural_size(parameter.dimension, recording.scales())


def bounds(model: Model, recording: Recording) -> tuple[Array, Array, Array]:
    """Lower bounds, upper bounds and starts, arrays [p]; all three are equal where one is held."""
    rows = scaled_parameters(model, recording)
    lower = np.array([p.lower for p in rows], dtype=np.float64)
    upper = np.array([p.upper for p in rows], dtype=np.float64)
    start = np.array([p.start for p in rows], dtype=np.float64)
    return lower, upper, start


#: How far below the coldest sample a law that has no limit at its base temperature puts it (K).
COLD_MARGIN = 20.0
#: Largest share of the speed over which a law smooths the sign of the velocity.
SMOOTHING = 0.01


def law_constants(law: str, recording: Recording) -> dict[str, float]:
    """The constants that a law needs, taken from the recording.

    The base temperature is the mean, about which a factor of temperature is least tied to the
    friction it multiplies; for a law that has no limit there it lies well below the data. The sign
    is smoothed where noise leaves it in doubt, so that tanh is 1 on all rows that move. An exponent
    that a law does not identify stays what its paper says. A law by formula has none.
    """
    row = law_row(law)
    if row is None:
        return {}
    speed = recording.scales()["speed"] or 1.0
    given = {
        "smoothing_velocity": min(SMOOTHING * speed, recording.velocity_threshold / 3.0)
        or SMOOTHING * speed,
        "largest_velocity": speed,
        "largest_acceleration": recording.scales()["acceleration"] or 1.0,
    }
    if recording.temperature is not None:
        coldest = float(np.min(recording.temperature))
        mean = float(np.mean(recording.temperature[recording.moving]))
        below = row["pole"] == "base_temperature"
        given["base_temperature"] = coldest - COLD_MARGIN if below else mean
    return {name: given[name] for name in row["constants"] if name in given}


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
    """A model of `spec` with units, constants and rigid-body terms for this recording.

    Parameters
    ----------
    spec
        ``"coulomb+load"``, a law by formula, or a model.
    """
    if isinstance(spec, str):
        spec = formula_law(spec) if is_formula(spec) else model(spec)
    constants = dict(spec.constants)
    if not np.any(np.isfinite(spec.values)):
        # Values that are known already mean something only with the constants they came with.
        constants = {**law_constants(spec.law, recording), **constants}
    for effect in spec.effects:
        needed = effect_constants(effect, recording)
        constants = {**needed, **constants}
    constants.update(known_constants(recording))
    made = Model(
        law=spec.law,
        own=spec.own,
        effects=spec.effects,
        constants=constants,
        limits=spec.limits,
        rigid_body=rigid_body_terms(recording, spec.effects),
        torque_unit=recording.torque_unit,
        position_unit=recording.position_unit,
        drive=recording.drive,
    )
    check_channels(made, recording)
    known = dict(zip(spec.names, spec.values, strict=True))
    return made.with_values([known.get(name, np.nan) for name in made.names])


def check_channels(model: Model, recording: Recording) -> None:
    """Refuse a model that needs a channel which the recording does not have or cannot use."""
    if model.drive != recording.drive:
        raise FitError(
            f"the model {model.spec} predicts {_effort(model.drive)}, but {recording.path} is read "
            f"as {_effort(recording.drive)}: "
            + ("leave --drive out" if model.drive is None else f"give --drive {model.drive}")
        )
    for effect in model.effects:
        refusal = of_catalog(effect).refusal(model, recording)
        if refusal is not None:
            raise FitError(refusal)
    for channel in model.core.needs:
        if channel == "motor_torque" and model.law in SIGN_OF_MOTOR_TORQUE and not model.drive:
            continue
        if channel == "load_torque" and model.rigid_body:
            continue
        if channel == "external_torque" and "gravity" in model.rigid_body:
            continue
        if channel == "motor_torque":
            # It is what a fit predicts: it follows from the balance of all torques.
            if model.has_state:
                raise FitError(
                    f"friction of {model.spec} depends on the motor torque, which cannot be solved "
                    "for in a model with a memory: leave out the effects that have one"
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
    _check_pole(model, recording)


def _check_pole(model: Model, recording: Recording) -> None:
    """Refuse temperatures on both sides of one at which the law has no limit."""
    row = law_row(model.law)
    name = None if row is None else row["pole"]
    if name is None or recording.temperature is None:
        return
    pole = 0.0 if name == "zero" else model.core.constants[name]
    coldest, warmest = float(recording.temperature.min()), float(recording.temperature.max())
    if coldest <= pole <= warmest:
        raise FitError(
            f"{model.spec} has no limit at {pole:g} degC, and the temperatures of {recording.path} "
            f"run from {coldest:.4g} to {warmest:.4g} degC: take rows on one side of it (--where), "
            f"or another law"
        )


def _effort(drive: str | None) -> str:
    return "a torque" if drive is None else f"the {drive} on a motor"
