"""Bounds, starts and constants of a model, scaled to a recording.

The catalog states bounds as multiples of scales of the recording (its largest speed, its torque
...), so that they do not depend on the size of the machine or on units.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.dimensions import CHANNELS, natural_size
from stribeck.base.errors import FitError, SpecError, option
from stribeck.effect.constants import effect_constants
from stribeck.effect.registry import of_catalog
from stribeck.identify.drive_scaling import drive_scales, known_constants
from stribeck.identify.problem import SIGN_OF_MOTOR_TORQUE
from stribeck.models.build import law as formula_law
from stribeck.models.build import model
from stribeck.models.catalog import catalog, law_row
from stribeck.models.channels import RIGID_BODY_EFFECTS
from stribeck.models.formula_law import is_formula
from stribeck.models.model import Model
from stribeck.models.parameter import Parameter
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Least sample period of the scale in s: at a higher rate, a filter delays by more samples.
LEAST_PERIOD = 1.0 / 120.0


def scale_values(recording: Recording) -> dict[str, float]:
    """The size of each scale of the catalog on this recording, in SI units."""
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
        "sample_period": max(s["sample_period"], LEAST_PERIOD),
        "duration": s["duration"] or 1.0,
        **drive_scales(recording),
    }


def scaled_parameters(model: Model, recording: Recording) -> tuple[Parameter, ...]:
    """The model's parameters with bounds and starts in their own units.

    Bounds and starts that a user gave replace those of the catalog. A parameter that the catalog
    holds has its known value, or else its start, as both bounds. The whole inertia, where no load
    torque holds a part of it, is not negative.
    """
    scales = scale_values(recording)
    made = []
    for p, value in zip(model.parameters, model.values, strict=True):
        scale = scales[p.scale]
        start = _formula_start(p, recording) if math.isnan(p.start) else p.start * scale
        lower, upper = p.lower * scale, p.upper * scale
        if p.name == "inertia" and "inertia" in model.rigid_body:
            lower = max(lower, 0.0)
        if p.name in model.limits:
            lower, upper = model.limits[p.name]
        elif p.role == "held":
            lower = upper = float(value) if math.isfinite(value) else start
        if p.name in model.stated.starts:
            start = _checked_start(p, model.stated.starts[p.name], lower, upper)
        start = min(max(start, lower), upper)
        drawn = _drawn(p.drawn[0] * scale, p.drawn[1] * scale, lower, upper)
        made.append(replace(p, lower=lower, upper=upper, start=start, drawn=drawn))
    return tuple(made)


def _checked_start(parameter: Parameter, start: float, lower: float, upper: float) -> float:
    """A start that a user gave; raise `SpecError` if it is outside the bounds."""
    if lower <= start <= upper:
        return start
    raise SpecError(
        f"parameter {parameter.name} starts at {start:g}, outside {lower:g} .. {upper:g} "
        f"{parameter.unit}: start inside, or give other bounds "
        f"({option('bounds', f'{parameter.name}=LOW:HIGH')})"
    )


def _drawn(low: float, high: float, lower: float, upper: float) -> tuple[float, float]:
    """The range of random starts within the bounds: the bounds if they exclude the range."""
    low, high = max(low, lower), min(high, upper)
    return (low, high) if low < high else (lower, upper)


def _formula_start(parameter: Parameter, recording: Recording) -> float:
    """The start of a formula's parameter without one: the scale of its unit on this recording.

    A speed starts at a tenth of the largest one, where a Stribeck curve or a smoothed sign bends.
    """
    if parameter.dimension is None:
        return 1.0
    share = 0.1 if parameter.dimension == CHANNELS["velocity"] else 1.0
    return share * natural_size(parameter.dimension, recording.scales())


def bounds(model: Model, recording: Recording) -> tuple[Array, Array, Array]:
    """Lower bounds, upper bounds and starts, arrays [p]; all three are equal if one is held."""
    rows = scaled_parameters(model, recording)
    lower = np.array([p.lower for p in rows], dtype=np.float64)
    upper = np.array([p.upper for p in rows], dtype=np.float64)
    start = np.array([p.start for p in rows], dtype=np.float64)
    return lower, upper, start


#: Least distance (K) of the base temperature from the coldest sample, for laws with no limit there.
COLD_MARGIN = 20.0
#: Speed up to which a law smooths the sign of the velocity, as a share of the largest one.
SMOOTHING = 0.01


def law_constants(law: str, recording: Recording) -> dict[str, float]:
    """The constants that a law needs, taken from the recording.

    The base temperature is the mean temperature, where a temperature factor is least correlated
    with the friction that it multiplies; for a law that has no limit there it is well below the
    data, 0 degC where that is far enough. The sign is smoothed at speeds where noise makes it
    uncertain, so that tanh is 1 on all moving samples. An exponent that a law does not identify
    keeps the value of its paper. A law by formula has no constants.
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
        given["base_temperature"] = min(coldest - COLD_MARGIN, 0.0) if below else mean
    return {name: given[name] for name in row["constants"] if name in given}


def rigid_body_terms(recording: Recording) -> tuple[str, ...]:
    """Rigid-body terms that must be identified together with friction on this recording."""
    if recording.load_torque is not None or recording.averaged:
        return ()
    terms = []
    for term in RIGID_BODY_EFFECTS:
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
        # Known values are valid only with the constants that they came with.
        constants = {**law_constants(spec.law, recording), **constants}
    known = {name for name, x in zip(spec.names, spec.values, strict=True) if np.isfinite(x)}
    for effect in spec.effects:
        row = catalog()["effects"][effect]
        # The period of a ripple takes milliseconds to find.
        if not constants.keys() >= set(row["constants"]):
            if not known.issuperset(parameter["name"] for parameter in row["parameters"]):
                constants = {**effect_constants(effect, recording), **constants}
    constants.update(known_constants(recording))
    rigid_body = rigid_body_terms(recording)
    made = Model(
        law=spec.law,
        own=spec.own,
        # Where no load torque is known, an inertia in a model is that of the rigid body.
        effects=tuple(effect for effect in spec.effects if effect not in rigid_body),
        constants=constants,
        limits=spec.limits,
        stated=spec.stated,
        rigid_body=rigid_body,
        torque_unit=recording.torque_unit,
        position_unit=recording.position_unit,
        drive=recording.drive,
    )
    check_channels(made, recording)
    values = dict(zip(spec.names, spec.values, strict=True))
    return made.with_values([values.get(name, np.nan) for name in made.names])


def check_channels(model: Model, recording: Recording) -> None:
    """Refuse a model that reads a channel that the recording lacks or cannot provide.

    Raises
    ------
    FitError
    """
    if model.drive != recording.drive:
        raise FitError(
            f"the model {model.spec} predicts {_effort(model.drive)}, but {recording.path} is read "
            f"as {_effort(recording.drive)}: "
            + (
                f"leave out {option('drive')}"
                if model.drive is None
                else f"give {option('drive', model.drive)}"
            )
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
            # A fit predicts it: it follows from the torque balance.
            if model.has_state:
                raise FitError(
                    f"friction of {model.spec} depends on the motor torque, which cannot be solved "
                    "for in a model with memory: leave out the effects that have one"
                )
            continue
        if channel == "external_torque" and recording.external_torque is None:
            raise FitError(
                f"{model.spec} needs the torque of the environment, which {recording.path} does "
                "not have: give inertia and gravity_cos, gravity_sin in the sidecar, or map a "
                f"column with {option('map', 'external_torque=COLUMN')}"
            )
        if getattr(recording, channel, None) is None:
            raise FitError(
                f"{model.spec} needs the column {channel}, which {recording.path} does not have: "
                f"map one with {option('map', f'{channel}=COLUMN')}, or leave the effect out"
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
            f"run from {coldest:.4g} to {warmest:.4g} degC: select samples on one side of it "
            f"({option('where')}), or use another law"
        )


def _effort(drive: str | None) -> str:
    return "a torque" if drive is None else f"the {drive} on a motor"
