"""Passes at constant speed to and fro over a gravity load that nobody knows."""

from __future__ import annotations

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]

COULOMB, STRIBECK_HEIGHT, STRIBECK_VELOCITY, VISCOUS = 4.0, 1.5, 0.08, 1.8
TORQUE_NOISE = 0.05


def friction(velocity: Array) -> Array:
    """A Stribeck curve with viscous friction, N m."""
    dry = COULOMB + STRIBECK_HEIGHT * np.exp(-((velocity / STRIBECK_VELOCITY) ** 2))
    return np.sign(velocity) * dry + VISCOUS * velocity


def gravity(position: Array) -> Array:
    """What no model in these tests is told, N m."""
    return 14.0 * np.cos(position - 0.3) + 2.0 * np.sin(2.0 * position)


def log(
    speeds: list[float],
    *,
    rate: float = 200.0,
    seed: int = 3,
    stroke: float = 0.8,
    load_share: float = 0.0,
) -> pl.DataFrame:
    """Time, position, torque and temperature of one pass each way at each speed [rad/s].

    `load_share` of the gravity torque's size adds to the dry friction.
    """
    rng = np.random.default_rng(seed)
    ramp, rest = int(0.2 * rate), np.zeros(int(0.4 * rate))
    parts = [rest]
    for speed in speeds:
        level = np.concatenate(
            [
                np.linspace(0, 1, ramp),
                np.ones(int(stroke / speed * rate)),
                np.linspace(1, 0, ramp),
                rest,
            ]
        )
        parts += [speed * level, -speed * level]
    velocity = np.concatenate(parts)
    position = -0.2 + np.cumsum(velocity) / rate
    load = gravity(position)
    torque = load + 0.6 * np.gradient(velocity, 1.0 / rate) + friction(velocity)
    torque += load_share * np.abs(load) * np.sign(velocity)
    time = np.arange(velocity.size) / rate
    return pl.DataFrame(
        {
            "time": time,
            "position": position + 2e-5 * rng.standard_normal(time.size),
            "torque": torque + TORQUE_NOISE * rng.standard_normal(time.size),
            "temperature": 30.0 + 5.0 * time / time[-1],
        }
    )
