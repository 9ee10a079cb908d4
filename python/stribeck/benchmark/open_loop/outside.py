"""Effects outside the library: the correct result is "unexplained"."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.moves import Array

#: Relative change of the dry friction as a function of time, position, speed and acceleration.
Change = Callable[[Array, Array, Array, Array], Array]

OUTSIDE = (
    "acceleration_sign",
    "humidity",
    "second_axis_load",
    "speed_gap",
    "position_speed",
    "restart",
)


def draw_outside(
    rng: np.random.Generator, joint: SimulatedJoint, duration: float, swaps: Array
) -> dict[str, Change]:
    """Draw one form of each effect.

    acceleration_sign
        Dry friction is higher during acceleration than during deceleration.
    humidity
        Dry friction oscillates slowly, with a period that is in no channel.
    second_axis_load
        A bearing also carries the load of another joint, which changes with the pose of that joint.
    speed_gap
        Dry friction steps up in a band of speed.
    position_speed
        Tight spots move with speed, so the effect is not a function of position or speed alone.
    restart
        Friction changes randomly at every start after a stop.
    """
    swing = duration / rng.uniform(4.0, 9.0)
    phase = float(rng.uniform(0, 2 * math.pi))
    edges = np.sort(rng.uniform(0.0, duration, 3 * len(swaps) + 8))
    carried = rng.uniform(0.0, 1.0, len(edges) + 1)
    low = joint.vmax * log_uniform(rng, 0.08, 0.2)
    high = low * float(rng.uniform(1.6, 2.4))
    wave = math.pi * float(rng.uniform(1.5, 3.0)) / joint.half
    half_speed = joint.vmax * float(rng.uniform(0.2, 0.35))
    stretches = np.sort(np.concatenate([swaps, rng.uniform(0.0, duration, len(swaps))]))
    luck = rng.standard_normal(len(stretches) + 1)
    return {
        "acceleration_sign": lambda t, q, v, a: np.sign(v * a),
        "humidity": lambda t, q, v, a: np.sin(2 * math.pi * t / swing + phase),
        "second_axis_load": lambda t, q, v, a: carried[np.searchsorted(edges, t)] - 0.5,
        "speed_gap": lambda t, q, v, a: ((np.abs(v) > low) & (np.abs(v) < high)) * 1.0,
        "position_speed": lambda t, q, v, a: (
            np.sin(wave * (q - joint.centre)) * np.tanh(2 * np.log(np.abs(v) / half_speed + 1e-9))
        ),
        "restart": lambda t, q, v, a: np.clip(luck[np.searchsorted(stretches, t)], -2.5, 2.5),
    }
