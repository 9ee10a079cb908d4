"""A servo with a pendulum, simulated with numpy alone: M3 friction behind a DC motor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import stribeck as sb
from numpy.typing import NDArray

Array = NDArray[np.float64]

INERTIA, GRAVITY = 0.005, 0.48
#: What a fit has to find, by symbol.
TRUTH = {"Kc": 0.02, "Kl": 0.15, "Kv": 0.01, "Ja": 0.002, "kt": 0.35, "R": 3.2}


def friction(
    external: Array, motor: Array, velocity: Array, truth: dict[str, float] = TRUTH
) -> Array:
    """Servo law M3 as it is printed, [n]."""
    dry = truth["Kc"] + truth["Kl"] * np.abs(external - motor)
    return dry * np.sign(velocity) + truth["Kv"] * velocity


def balanced(external: Array, load: Array, velocity: Array) -> Array:
    """The motor torque that moves the load, by fixed-point iteration, [n]."""
    motor = load.copy()
    for _ in range(200):
        motor = load + friction(external, motor, velocity)
    return motor


def released(dt: float, rows: int, start: float) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration of the pendulum let go with the servo off, [n]."""
    q, v = np.zeros(rows), np.zeros(rows)
    a = np.zeros(rows)
    q[0] = start
    fine = 20
    at, speed = start, 0.0
    for i in range(rows):
        for _ in range(fine):
            external = -GRAVITY * np.sin(at)
            dry = TRUTH["Kc"] + TRUTH["Kl"] * abs(external)
            direction = np.sign(speed) if speed else np.sign(external)
            push = external - dry * direction - TRUTH["Kv"] * speed
            pace = push / (INERTIA + TRUTH["Ja"])
            if speed and np.sign(speed + pace * dt / fine) != np.sign(speed):
                pace = speed = 0.0
            speed += pace * dt / fine
            at += speed * dt / fine
        q[i], v[i], a[i] = at, speed, pace
    return q, v, a


def servo(seed: int = 0, noise: float = 0.02) -> pl.DataFrame:
    """Six driven runs at three gains and three releases; `effort_V` is 0 while the servo is off."""
    rng = np.random.default_rng(seed)
    dt, rows = 0.005, 600
    frames = []
    for run in range(9):
        t = np.arange(rows) * dt
        if run < 6:
            w = 2.0 + 0.7 * run
            q = 0.9 * np.sin(w * t) + 0.2 * np.sin(2.3 * w * t + run)
            v = 0.9 * w * np.cos(w * t) + 0.46 * w * np.cos(2.3 * w * t + run)
            a = -0.9 * w**2 * np.sin(w * t) - 1.058 * w**2 * np.sin(2.3 * w * t + run)
            external = -GRAVITY * np.sin(q)
            motor = balanced(external, (INERTIA + TRUTH["Ja"]) * a - external, v)
            effort = TRUTH["R"] / TRUTH["kt"] * motor + TRUTH["kt"] * v
            effort = effort + noise * rng.standard_normal(rows)
        else:
            q, v, a = released(dt, rows, 0.5 + 0.2 * (run - 6))
            effort = np.zeros(rows)
        frames.append(
            pl.DataFrame(
                {
                    "t_s": t,
                    "q_rad": q,
                    "qd_radps": v + 1e-3 * rng.standard_normal(rows),
                    "qdd_radps2": a,
                    "effort_V": effort,
                    "enabled": run < 6,
                    "run": run,
                    "gain": run % 3,
                }
            )
        )
    return pl.concat(frames)


def recorded(folder: Path, frame: pl.DataFrame, **options: object) -> sb.Recording:
    """The frame as a recording of a known pendulum behind a voltage drive."""
    path = folder / "servo.parquet"
    frame.write_parquet(path)
    (folder / "servo.parquet.sidecar.toml").write_text(
        'kind = "recording"\njoint_kind = "revolute"\ndrive = "voltage"\n'
        f"inertia = {INERTIA}\ngravity_sin = {GRAVITY}\n"
        '[map]\ntorque = "effort_V"\nacceleration = "qdd_radps2"\n'
    )
    return sb.read(path, **options)
