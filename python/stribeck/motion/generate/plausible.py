"""A plausible value for every parameter of every law and effect."""

from __future__ import annotations

from collections import ChainMap

import numpy as np

from stribeck.effect.registry import of_catalog
from stribeck.models.catalog import catalog
from stribeck.models.model import Model
from stribeck.motion.generate.motion import GeneratedJoint


def plausible_values(
    model: Model, joint: GeneratedJoint, rng: np.random.Generator
) -> dict[str, float]:
    """A value of every parameter in its unit, from the joint's sizes and the catalog's starts."""
    c, b = joint.coulomb, joint.viscous
    scales = {
        "none": 1.0,
        "speed": joint.speed,
        "position": joint.stroke,
        "torque": 2.0 * c,
        "stiffness": c / joint.stroke,
        "damping": b,
        "square_damping": b / joint.speed,
        "cubic_damping": b / joint.speed**2,
        "root_damping": b * joint.speed**0.5,
        "inverse_speed": 1.0 / joint.speed,
        "inverse_torque": 0.5 / c,
        "torque_rate": c * joint.speed / joint.stroke,
        "inertia": joint.inertia,
        "sample_period": 1.0,
        "duration": 100.0,
        "time": joint.stroke / joint.speed,
        "square_time": (joint.stroke / joint.speed) ** 2,
    }
    laws = {
        "coulomb_friction": c,
        "viscous_friction": b,
        "static_friction": 1.5 * c,
        "viscous_friction_forward": b,
        "viscous_friction_backward": b,
        "external_coulomb": 0.12,
        "motor_coulomb": 0.16,
        "external_stribeck": 0.04,
        "motor_stribeck": 0.05,
        "external_quadratic": 0.04 / joint.gravity,
        "motor_quadratic": 0.02 / joint.gravity,
        "bristle_stiffness": 300.0 * c / joint.stroke,
        "bristle_damping": 0.1 * b,
    }
    known = ChainMap(laws)
    values = {}
    for p in model.parameters:
        effect = effect_of(p.name)
        if effect is not None and p.name not in known:
            known = known.new_child(of_catalog(effect).plausible(joint, rng))
        values[p.name] = float(known.get(p.name, p.start * scales[p.scale]))
    return values


def effect_of(parameter: str) -> str | None:
    """The effect that has a parameter of this name; laws name the same term alike."""
    for effect, row in catalog()["effects"].items():
        if any(p["name"] == parameter for p in row["parameters"]):
            return effect
    return None
