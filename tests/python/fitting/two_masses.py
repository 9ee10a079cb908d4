"""A motor and a joint with a transmission between them, by numpy alone.

The spring has a gap and, in parallel, a slip element that makes a hysteresis; dry friction acts on
both sides. Symplectic Euler steps of 0.1 ms; signs are smoothed over 1 mrad/s.
"""

from __future__ import annotations

import functools

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]

RATIO = 100.0


def recorded(
    *,
    quantum: float = 2.0 * np.pi / 2**19,
    noise: float = 0.0,
    torque_noise: float = 0.1,
    seed: int = 0,
    **joint: float,
) -> pl.DataFrame:
    """What both encoders and the motor's current show, at 1 kHz.

    Parameters
    ----------
    quantum, noise
        Step and RMS noise of both encoders at the joint side, rad.
    **joint
        As of `moved`.
    """
    time, motor, position, torque = moved(**joint)
    rng = np.random.default_rng(seed)
    seen = np.column_stack([motor, position])
    seen = seen + noise * rng.standard_normal(seen.shape)
    seen = quantum * np.round(seen / quantum) if quantum else seen
    return pl.DataFrame(
        {
            "time": time,
            "position": seen[:, 1],
            "motor_position": RATIO * seen[:, 0] + 1.7,
            "torque": torque + torque_noise * rng.standard_normal(time.size),
        }
    )


@functools.cache
def moved(
    *,
    stiffness: float = 2e4,
    gap: float = 0.0,
    slip: float = 0.0,
    motor_friction: float = 3.0,
    joint_friction: float = 2.0,
    gravity: float = 20.0,
    offset: float = 0.0,
    seconds: float = 12.0,
    locked: bool = False,
) -> tuple[Array, Array, Array, Array]:
    """Time, positions of motor and joint at the joint side, and torque of the motor, arrays [n].

    Parameters
    ----------
    slip
        Half the width of the hysteresis, N m.
    offset
        Constant torque at the joint, N m.
    locked
        Whether the joint is held.
    """
    step, every = 1e-4, 10
    count = round(seconds / step)
    time = step * np.arange(count)
    # It starts slowly, so that the transmission is not struck.
    start = 0.5 - 0.5 * np.cos(np.pi * np.minimum(time / 2.0, 1.0))
    wanted = 1.2 * np.sin(2 * np.pi * 0.3 * time) + 0.4 * np.sin(2 * np.pi * 0.71 * time)
    wanted *= start
    pushed = 12.0 * np.sin(2 * np.pi * 0.2 * time) * np.minimum(1.0, time / seconds + 0.3)
    rate = np.gradient(wanted, step)
    inertia = 0.5
    q = p = v = u = held = 0.0
    rows = np.empty((count // every, 3))
    for k in range(count):
        motor = 4000.0 * (wanted[k] - q) + 80.0 * (rate[k] - v) if not locked else pushed[k]
        w = q - p
        spring = stiffness * (max(w - gap / 2, 0.0) + min(w + gap / 2, 0.0))
        if slip:
            held = min(max(held + 5.0 * stiffness * (v - u) * step, -slip), slip)
        through = spring + held + 20.0 * (v - u) * (spring != 0.0)
        v += step * (motor - through - motor_friction * np.tanh(1e3 * v)) / inertia
        load = gravity * np.cos(p) + offset + joint_friction * np.tanh(1e3 * u)
        u = 0.0 if locked else u + step * (through - load) / inertia
        q, p = q + step * v, p + step * u
        if k % every == 0:
            rows[k // every] = q, p, motor
    return time[::every], rows[:, 0], rows[:, 1], rows[:, 2]
