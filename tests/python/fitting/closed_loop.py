"""A joint with friction under a controller that reads a noisy encoder: many recordings at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import polars as pl

#: Parameters of the joint, which has no gravity.
TRUE = {
    "viscous_friction": 1.5,
    "coulomb_friction": 2.0,
    "stribeck_height": 1.0,
    "stribeck_velocity": 0.15,
    "inertia": 0.5,
    "gravity_cos": 0.0,
    "gravity_sin": 0.0,
}
#: Controller and plant are stepped at this rate; each tenth step is recorded.
RATE, EVERY = 5000, 10
#: Standard deviation of the encoder's noise and its resolution, rad.
ENCODER, RESOLUTION = 2e-5, 2.0 * np.pi / 2**20
#: Standard deviation of the noise of the measured torque, N m.
TORQUE_NOISE = 0.05
#: Natural frequency (rad/s) and damping of the controlled joint.
FREQUENCY, DAMPING = 2.0 * np.pi * 6.0, 0.9
#: Share of a new sample in the controller's filtered velocity.
FILTER = 0.2


def reference(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, velocity and acceleration of the reference trajectory, [n] each."""
    size, w = np.array([0.5, 0.15, 0.06]), 2.0 * np.pi * np.array([0.25, 0.6, 1.1])
    phase = np.outer(time, w)
    return (
        np.sin(phase) @ size,
        np.cos(phase) @ (size * w),
        -np.sin(phase) @ (size * w * w),
    )


def closed_loop(
    seeds: Sequence[int], *, noisy: bool = True, seconds: float = 40.0
) -> list[pl.DataFrame]:
    """One recording for each seed.

    Parameters
    ----------
    noisy
        Whether the encoder is noisy and quantised, and velocity and acceleration are differences of
        its readings; otherwise all motion is exact. The measured torque is noisy in any case.
    """
    generators = [np.random.default_rng(seed) for seed in seeds]
    step, steps = 1.0 / RATE, round(seconds * RATE)
    time = np.arange(steps) * step
    wanted = reference(time)
    noise = np.stack([rng.standard_normal(steps) for rng in generators], axis=1)
    read, speed, pull, effort = _run(wanted, ENCODER * noise if noisy else None, step, len(seeds))
    rows = np.arange(EVERY, steps - EVERY, EVERY)
    apart = EVERY * step
    before, after = read[rows - EVERY], read[rows + EVERY]
    if noisy:
        speed = (after - before) / (2.0 * apart)
        pull = (after - 2.0 * read[rows] + before) / apart**2
    else:
        speed, pull = speed[rows], pull[rows]
    names = ("reference_position", "reference_velocity", "reference_acceleration")
    shared = {"time": time[rows], **{n: x[rows] for n, x in zip(names, wanted, strict=True)}}
    return [
        pl.DataFrame(
            {
                **shared,
                "position": read[rows, i],
                "velocity": speed[:, i],
                "acceleration": pull[:, i],
                "torque": effort[rows, i] + TORQUE_NOISE * rng.standard_normal(rows.size),
            }
        )
        for i, rng in enumerate(generators)
    ]


def _run(
    wanted: tuple[np.ndarray, ...], noise: np.ndarray | None, step: float, count: int
) -> tuple[np.ndarray, ...]:
    """Encoder reading, true velocity, true acceleration and motor torque, [steps, count] each.

    The controller has feedback of position and filtered velocity, and a feedforward of roughly
    known inertia and friction.
    """
    inertia, viscous = TRUE["inertia"], TRUE["viscous_friction"]
    static = TRUE["coulomb_friction"] + TRUE["stribeck_height"]
    stiffness, damper = inertia * FREQUENCY**2, 2.0 * DAMPING * inertia * FREQUENCY
    q, v = np.full(count, wanted[0][0]), np.full(count, wanted[1][0])
    made = tuple(np.empty((wanted[0].size, count)) for _ in range(4))
    filtered, last = v, q
    for k, (q_r, v_r, a_r) in enumerate(zip(*wanted, strict=True)):
        read = q if noise is None else np.round((q + noise[k]) / RESOLUTION) * RESOLUTION
        if k:
            filtered = filtered + FILTER * ((read - last) / step - filtered)
        last = read
        known = inertia * a_r + 1.3 * v_r + 1.8 * np.sign(v_r)
        effort = stiffness * (q_r - read) + damper * (v_r - filtered) + known
        falling = TRUE["stribeck_height"] * np.exp(-((v / TRUE["stribeck_velocity"]) ** 2))
        friction = viscous * v + np.sign(v) * (TRUE["coulomb_friction"] + falling)
        pull = (effort - friction) / inertia
        for column, value in zip(made, (read, v, pull, effort), strict=True):
            column[k] = value
        after = v + step * pull
        # The joint stops where its velocity changes sign, until the torque breaks it loose.
        loose = np.sign(effort) * np.maximum(np.abs(effort) - static, 0.0) * step / inertia
        after = np.where(after * v <= 0.0, loose, after)
        q, v = q + 0.5 * step * (v + after), after
    return made
