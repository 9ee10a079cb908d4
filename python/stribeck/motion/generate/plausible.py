"""A plausible value for every parameter of every law and effect."""

from __future__ import annotations

import numpy as np

from stribeck.models.model import Model
from stribeck.motion.generate.motion import Joint


def plausible_values(model: Model, joint: Joint, rng: np.random.Generator) -> dict[str, float]:
    """A value for every parameter, from the joint's sizes and the catalog's starts."""
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
        "time": joint.stroke / joint.speed,
        "square_time": (joint.stroke / joint.speed) ** 2,
    }
    own = {
        "coulomb_friction": c,
        "viscous_friction": b,
        "static_friction": 1.5 * c,
        "viscous_friction_forward": b,
        "viscous_friction_backward": b,
        "stribeck_height": 0.35 * c,
        "stribeck_velocity": 0.05 * joint.speed,
        "stribeck_exponent": 1.4,
        "temperature_dry_slope": 0.012,
        "temperature_dry_curvature": 0.01,
        "temperature_viscous_slope": 0.03,
        "temperature_viscous_curvature": 0.02,
        "load_coulomb": 0.16,
        "load_exponent": 1.0,
        "load_stribeck": 0.0,
        "external_coulomb": 0.12,
        "motor_coulomb": 0.16,
        "external_stribeck": 0.04,
        "motor_stribeck": 0.05,
        "external_quadratic": 0.04 / joint.gravity,
        "motor_quadratic": 0.02 / joint.gravity,
        "quadrant_coulomb": 0.1,
        "quadrant_viscous": 0.05 / joint.speed,
        "direction_coulomb": 0.15 * c,
        "direction_viscous": 0.15 * b,
        "nonlinear_viscous_coefficient": 0.6 * b,
        "nonlinear_viscous_exponent": 2.0,
        "nonlinear_viscous_saturation": 100.0 * joint.speed,
        "offset": 0.12 * c,
        "inertia": 0.4 * joint.inertia,
        "gravity_cos": 0.12 * joint.gravity,
        "gravity_sin": 0.08 * joint.gravity,
        "spring_linear": 0.3 * c,
        "spring_quadratic": 0.05 * c,
        "spring_cubic": 0.1 * c,
        "ripple_cos": 0.12 * c,
        "ripple_sin": 0.08 * c,
        "ripple_second_cos": 0.03 * c,
        "ripple_second_sin": 0.02 * c,
        "drift_change": -0.25,
        "drift_curvature": 3.0,
        "saturation": 0.12,
        "saturation_exponent": 2.0,
        "gain": 0.08,
        "frictional_lag": 0.1 * joint.stroke / joint.speed,
        "backlash_gap": 0.08 * joint.stroke,
        "backlash_exponent": 0.6,
        "backlash_return": 0.4,
        "elasticity": 0.002 * (joint.stroke / joint.speed) ** 2,
        "presliding_stiffness": 150.0 * c / joint.stroke,
        "presliding_damping": 0.1 * b,
        "bristle_stiffness": 300.0 * c / joint.stroke,
        "bristle_damping": 0.1 * b,
    }
    values = {}
    for p in model.parameters:
        if p.name.startswith("position_"):
            order = int(p.name.rsplit("_", 1)[1])
            values[p.name] = float(0.22 * c * rng.uniform(-1.0, 1.0) / order)
        else:
            values[p.name] = float(own.get(p.name, p.start * scales[p.scale]))
    return values
