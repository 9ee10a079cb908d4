"""The ball-screw joint of seed paper "Gantry": its table 1, and a stand that drives it.

Written with numpy alone, so that no test shares the product's formulas.
"""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Table 1: N, N, m/s, and N s/m (the print says N s2/m2) forward and backward.
COULOMB, STATIC, STRIBECK, FORWARD, BACKWARD = 10300.0, 12300.0, 0.002, 3218.9, 15277.0
#: Mass moved [kg], inertia of the motor shaft [kg m2], pitch of the screw [m].
MASS, SHAFT_INERTIA, PITCH = 11.250, 1.2298e-5, 6.41e-3
#: Stiffness of the drive's speed control in N s/m: well above the fall of the Stribeck curve
#: (8.6e5 N s/m), or the slow speeds could not be held.
DRIVE = 2.0e7


def equivalent_mass() -> float:
    """Mass that the drive feels, M + J (2 pi / p)^2, in kg (table 1: 23.053)."""
    return MASS + SHAFT_INERTIA * (2.0 * np.pi / PITCH) ** 2


def friction(velocity: float) -> float:
    """Equation 2 in N, at a velocity in m/s other than zero."""
    dry = COULOMB + (STATIC - COULOMB) * np.exp(-((velocity / STRIBECK) ** 2))
    return np.sign(velocity) * dry + (FORWARD if velocity > 0 else BACKWARD) * velocity


def driven(reference: Array, step: float) -> tuple[Array, Array]:
    """Velocity [m/s] and force of the drive [N] that follow a reference speed, arrays [n].

    M_eq dv/dt + F(v) = K (reference - v), by implicit Euler: the speed solves one rising equation
    a step, and stays zero while the drive pulls with less than the static friction.
    """
    mass = equivalent_mass() / step
    velocity, before = np.zeros_like(reference), 0.0
    for k, wanted in enumerate(reference):
        pull = mass * before + DRIVE * wanted
        v = 0.0
        if abs(pull) > STATIC:
            v = (pull - np.sign(pull) * COULOMB) / (mass + DRIVE)
            for _ in range(50):
                slope = (friction(v * (1 + 1e-6)) - friction(v)) / (v * 1e-6)
                change = ((mass + DRIVE) * v + friction(v) - pull) / (mass + DRIVE + slope)
                v -= change
                if abs(change) < 1e-13:
                    break
        velocity[k] = before = v
    return velocity, DRIVE * (reference - velocity)


def passes(speeds: list[float], *, rate: float, stroke: float = 0.4) -> Array:
    """Reference speed of one pass each way at each speed, ramps and rests between, array [n]."""
    ramp, rest = int(0.15 * rate), np.zeros(int(0.3 * rate))
    parts = [rest]
    for speed in speeds:
        seconds = float(np.clip(stroke / speed, 1.0, 6.0))
        level = np.concatenate(
            [np.linspace(0, 1, ramp), np.ones(int(seconds * rate)), np.linspace(1, 0, ramp), rest]
        )
        parts += [speed * level, -speed * level]
    return np.concatenate(parts)


def displacement_log(
    speeds: list[float],
    *,
    seed: int = 0,
    rate: float = 500.0,
    position_noise: float = 10e-6,
    quantum: float = 5e-6,
    force_noise: float = 50.0,
) -> pl.DataFrame:
    """A log of displacement and force, as the stand's data acquisition writes it.

    Parameters
    ----------
    speeds
        Of the passes, m/s, each driven there and back.
    position_noise, quantum
        RMS noise of the linear sensor and its step, m.
    force_noise
        RMS, N: half a per cent of the Coulomb friction.
    """
    rng = np.random.default_rng(seed)
    velocity, force = driven(passes(speeds, rate=rate), 1.0 / rate)
    position = np.cumsum(velocity) / rate + position_noise * rng.standard_normal(velocity.size)
    return pl.DataFrame(
        {
            "time": np.arange(velocity.size) / rate,
            "position": quantum * np.round(position / quantum),
            "torque": force + force_noise * rng.standard_normal(force.size),
        }
    )
