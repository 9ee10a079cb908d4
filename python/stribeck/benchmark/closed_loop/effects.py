"""Effects that can be hidden in a controlled joint, and their amplitudes."""

from __future__ import annotations

EFFECTS = (
    "stribeck",
    "nonlinear_viscous",
    "direction",
    "load",
    "quadrant",
    "temperature_viscous",
    "temperature_dry",
    "presliding",
    "frictional_lag",
    "position",
    "drift",
    "offset",
    "ripple",
    "gain",
    "delay",
    "inertia",
    "gravity",
    "backlash",
    "elasticity",
    "spring",
    "saturation",
)

#: Effects outside the library.
OUTSIDE = (
    "acceleration_sign",
    "humidity",
    "second_axis_load",
    "speed_gap",
    "position_speed",
    "restart",
)

#: Effects that each limited motion cannot show.
LIMITS: dict[str, list[str]] = {
    "isothermal": ["temperature_viscous", "temperature_dry"],
    "warm_up_only": ["drift"],
}

#: Simpler effects that an effect contains; naming them too is not an error.
IMPLIED = {"quadrant": ["load"], "frictional_lag": ["stribeck"]}

#: Amplitudes, in the units of `Friction`, `Actuator` and `Transmission`: start of the search for
#: the wanted size, and the largest physical one.
AMPLITUDES: dict[str, tuple[float, float]] = {
    "stribeck": (0.2, 1.2),
    "nonlinear_viscous": (0.8, 5.0),
    "direction": (0.1, 0.7),
    "load": (0.15, 1.5),
    "quadrant": (0.2, 1.5),
    "temperature_viscous": (0.15, 1.0),
    "temperature_dry": (0.1, 0.6),
    "presliding": (4e-3, 3e-2),
    "frictional_lag": (0.02, 0.12),
    "position": (0.1, 0.8),
    "drift": (0.1, 0.7),
    "offset": (0.05, 0.8),
    "ripple": (0.05, 1.0),
    "gain": (0.03, 0.3),
    "delay": (4e-3, 2.5e-2),
    "inertia": (0.05, 0.6),
    "gravity": (0.05, 0.5),
    "backlash": (1e-3, 3e-2),
    "elasticity": (0.1, 1.0),
    "spring": (0.05, 1.5),
    "saturation": (0.1, 0.6),
    **dict.fromkeys(OUTSIDE, (0.15, 0.7)),
}

#: Smallest amplitude that the samples can show: a presliding distance above the encoder resolution,
#: a gap not crossed between two samples, a resonance slower than the sampling. For smaller sizes
#: the noise is raised instead, within physical limits.
LEAST_AMPLITUDES = {"presliding": 1.5e-3, "backlash": 5e-4, "elasticity": 0.03}
