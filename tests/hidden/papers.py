"""Recordings whose friction is a published model, to be found from a simpler one.

Nothing of the product is imported: the formulas stand here as the papers mean them.
"""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Noise with which M* itself errs by 3.39e-3 on average (Bittencourt et al. 2010, section III D).
M_STAR_NOISE = 3.39e-3 * np.sqrt(np.pi / 2.0)


def m_star(velocity: Array, load: Array, temperature: Array) -> Array:
    """Friction of M* with tables I and II of Bittencourt et al. 2010 (joint 2 of an ABB robot).

    `velocity` [rad/s, motor side], `load` and the result normalised by the largest manipulation
    torque, `temperature` [degC]. Its Stribeck velocity -25 + T vanishes at 25 degC.
    """
    speed, size = np.abs(velocity), np.abs(load)
    loaded = (3.04e-2 + 2.32e-2 * size) + 1.28e-1 * size * np.exp(-((speed / 9.07) ** 1.3))
    warm = (-2.44e-2 + 1.69e-3 * temperature) * np.exp(
        -((speed / np.abs(-25.0 + temperature)) ** 1.3)
    )
    viscous = (1.29e-4 + 1.31e-3 * np.exp(-temperature / 21.0)) * velocity
    return np.sign(velocity) * (loaded + warm) + viscous


def m0(velocity: Array) -> Array:
    """Friction of M0 with the parameters identified in the same paper (section II A)."""
    speed = np.abs(velocity)
    dry = 3.24e-2 + 3.84e-2 * np.exp(-((speed / 13.80) ** 1.91))
    return np.sign(velocity) * dry + 4.04e-4 * velocity


def static_friction_curves(seed: int, curves: int = 60) -> pl.DataFrame:
    """Static friction curves of M* under changing load and temperature.

    Each curve holds 12 speeds from 1 to 270 rad/s in both directions, five samples each, at one
    load within +-0.8 and one temperature within 30 to 40 degC.
    """
    rng = np.random.default_rng(seed)
    speeds = np.geomspace(1.0, 270.0, 12)
    one = np.repeat(np.column_stack([speeds, -speeds]).ravel(), 5)
    velocity = np.tile(one, curves)
    load = np.repeat(rng.uniform(-0.8, 0.8, curves), one.size)
    temperature = np.repeat(rng.uniform(30.0, 40.0, curves), one.size)
    friction = m_star(velocity, load, temperature)
    return pl.DataFrame(
        {
            "time": 0.1 * np.arange(velocity.size),
            "velocity": velocity,
            "load_torque": load,
            "temperature": temperature,
            "friction_torque": friction + rng.normal(0.0, M_STAR_NOISE, velocity.size),
        }
    )


def comprehensive(seed: int, seconds: float = 160.0, rate: float = 250.0) -> pl.DataFrame:
    """A joint with the friction of Tadese et al. 2021, eqs 8-18, and table 2's bristles (joint 2).

    The paper prints neither Coulomb, viscous nor load parameters: those here are of the size its
    figures show, and passive (b + a tl along the motion in every quadrant). The state is stepped
    on a grid 16 times finer than the rows; the joint swings under a payload that changes sign with
    the angle, warms up and cools down.
    """
    rng = np.random.default_rng(seed)
    fine = 16
    dt = 1.0 / (rate * fine)
    time = np.arange(int(seconds * rate) * fine) * dt
    position, velocity, acceleration = _swing(time, rng)
    temperature = 26.0 + 20.0 * np.sin(np.pi * time / seconds) ** 2
    load = 38.0 * np.sin(position) + 1.4 * acceleration
    friction = _bristle(velocity, dt) + _algebraic(velocity, temperature, load)
    rows = slice(0, None, fine)
    torque = (friction + load)[rows] + rng.normal(0.0, 0.15, time[rows].size)
    return pl.DataFrame(
        {
            "time": time[rows],
            "position": position[rows],
            "velocity": velocity[rows],
            "acceleration": acceleration[rows],
            "torque": torque,
            "load_torque": load[rows],
            "temperature": temperature[rows],
        }
    )


def _swing(time: Array, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of a sum of sines with slow and fast stretches."""
    position = np.zeros_like(time)
    velocity = np.zeros_like(time)
    acceleration = np.zeros_like(time)
    for frequency, reach in ((0.07, 0.9), (0.19, 0.35), (0.43, 0.16)):
        phase = rng.uniform(0.0, 2.0 * np.pi)
        w = 2.0 * np.pi * frequency
        position += reach * np.sin(w * time + phase)
        velocity += reach * w * np.cos(w * time + phase)
        acceleration -= reach * w * w * np.sin(w * time + phase)
    return position, velocity, acceleration


def _bristle(velocity: Array, dt: float) -> Array:
    """s0 z + s1(v) dz/dt with a Coulomb level per direction, stepped exactly on the fine grid."""
    s0, s1, vd = 12930.0, 233.0, 1e-3
    level = np.where(velocity > 0.0, 9.0, 8.2)
    rate = s0 * np.abs(velocity) / level
    decay = np.exp(-rate * dt)
    steady = level / s0 * np.sign(velocity)
    z = np.empty_like(velocity)
    last = 0.0
    for k in range(velocity.size):
        last = steady[k] + (last - steady[k]) * decay[k]
        z[k] = last
    slope = velocity - rate * z
    return s0 * z + s1 * np.exp(-np.abs(velocity) / vd) * slope


def _algebraic(velocity: Array, temperature: Array, load: Array) -> Array:
    """Viscous friction per direction and temperature (eq 13) and load per quadrant (eq 15)."""
    forward = velocity > 0.0
    above = temperature - 30.0
    amplitude = np.where(forward, 14.0 - 0.16 * above, 12.5 - 0.14 * above)
    speed_scale = np.where(forward, 0.55 + 0.006 * above, 0.60 + 0.005 * above)
    speed = np.abs(velocity)
    viscous = np.sign(velocity) * amplitude * (1.0 - np.exp(-speed / speed_scale))
    motoring = velocity * load > 0.0
    slope = np.where(motoring, 0.13 + 0.03 * speed, 0.02 + 0.01 * speed)
    base = np.where(motoring, 0.5 * (1.0 - np.exp(-3.0 * speed)) + 0.1, 0.1)
    return viscous + np.sign(velocity) * (base + slope * np.abs(load))
