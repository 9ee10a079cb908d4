"""Recordings that no command makes: passes at constant speed, an arm, points of three steps.

Plain Python, and numbers rounded to nine digits: every machine writes the same files.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable
from pathlib import Path

Row = dict[str, float]


def write(path: Path, rows: Iterable[Row]) -> None:
    """The rows as a CSV file."""
    rows = list(rows)
    lines = [",".join(rows[0])]
    lines += [",".join(f"{value:.9g}" for value in row.values()) for row in rows]
    path.write_text("\n".join(lines) + "\n")


def sign(x: float) -> float:
    return math.copysign(1.0, x) if x else 0.0


def stribeck(v: float) -> float:
    """Friction at a constant velocity [rad/s], N m."""
    return sign(v) * (4.0 + 1.5 * math.exp(-((v / 0.08) ** 2))) + 1.8 * v


def passes() -> list[Row]:
    """Six passes each way at constant speed over an unknown gravity load, 100 Hz."""
    rate, noise = 100, random.Random(3)
    velocities = [0.0] * 40
    for speed in (0.05, 0.1, 0.2, 0.4, 0.8, 1.2):
        ramp = [k / 20 for k in range(20)]
        level = [*ramp, *[1.0] * int(0.8 / speed * rate), *reversed(ramp), *[0.0] * 40]
        velocities += [speed * x for x in level] + [-speed * x for x in level]
    position, rows = -0.2, []
    for k, v in enumerate(velocities):
        position += v / rate
        gravity = 14.0 * math.cos(position - 0.3) + 2.0 * math.sin(2.0 * position)
        rows.append(
            {
                "time": k / rate,
                "position": position + noise.gauss(0.0, 2e-5),
                "torque": gravity + stribeck(v) + noise.gauss(0.0, 0.05),
                "temperature": 30.0 + 5.0 * k / len(velocities),
            }
        )
    return rows


def arm() -> list[Row]:
    """Two cycles of a planar arm of two joints, angles and torques side by side, 100 Hz."""
    rate, seconds, noise = 100, 10, random.Random(4)
    rows = []
    for cycle in (1, 2):
        for k in range(rate * seconds):
            t = k / rate
            q, v, a = zip(*(_fourier(joint, t, seconds) for joint in (1, 2)), strict=True)
            coupling, across = 0.34 * math.cos(q[1]), 0.34 * math.sin(q[1])
            first = (3.7 + 2.0 * coupling) * a[0] + (0.28 + coupling) * a[1]
            first -= across * v[1] * (2.0 * v[0] + v[1])
            second = (0.28 + coupling) * a[0] + 0.28 * a[1] + across * v[0] ** 2
            torque = first + 2.0 * stribeck(v[0]), second + 0.7 * stribeck(v[1])
            rows.append({"run": cycle, "time": t})
            for joint in (1, 2):
                rows[-1] |= {
                    f"q_{joint}": q[joint - 1] + noise.gauss(0.0, 2e-5),
                    f"torque_{joint}": torque[joint - 1] + noise.gauss(0.0, 0.1),
                }
    return rows


def _fourier(joint: int, t: float, seconds: float) -> tuple[float, float, float]:
    """Angle, velocity and acceleration of a joint on two harmonics."""
    q = v = a = 0.0
    for harmonic, size in ((1, 0.8), (joint + 2, 0.15)):
        w = 2.0 * math.pi * harmonic / seconds
        q += size * math.sin(w * t + joint)
        v += size * w * math.cos(w * t + joint)
        a -= size * w**2 * math.sin(w * t + joint)
    return q, v, a


SPEEDS = [way * s for s in (0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.2, 1.5) for way in (1, -1)]


def _point(run: int, v: float, temperature: float, load: float, noise: random.Random) -> Row:
    """A steady-state point: friction falls with temperature and grows with the load."""
    rise = 1.0 - math.exp(-abs(v) / (0.45 + 0.004 * temperature))
    friction = sign(v) * (9.0 + (20.0 - 0.17 * temperature) * rise)
    if load:
        friction += sign(v) * (1.0 - math.exp(-4.0 * abs(v)) + 0.3) + (0.1 + 0.02 * v) * load
    torque = friction + load + noise.gauss(0.0, 0.01)
    return {
        "run": run,
        "velocity": v,
        "temperature": temperature,
        "load_torque": load,
        "torque": torque,
    }


def no_load() -> list[Row]:
    """Points at twenty speeds and five temperatures, without load."""
    noise = random.Random(5)
    grid = [(v, t) for t in (20.0, 30.0, 40.0, 50.0, 60.0) for v in SPEEDS]
    return [_point(k, v, t, 0.0, noise) for k, (v, t) in enumerate(grid)]


def loaded() -> list[Row]:
    """Points at twenty speeds and six loads, all at 35 degC."""
    noise = random.Random(6)
    grid = [(v, load) for load in (-60.0, -30.0, -5.0, 5.0, 30.0, 60.0) for v in SPEEDS]
    return [_point(k, v, 35.0, load, noise) for k, (v, load) in enumerate(grid)]


def presliding() -> list[Row]:
    """A joint under a sinusoidal torque below its Coulomb friction, 500 Hz."""
    stiffness, damping, size, rate, noise = 12930.0, 233.0, 5.7, 500, random.Random(7)
    w = 0.0008 * stiffness / size
    delay = math.atan(damping * w / stiffness)
    rows = []
    for k in range(int(3.0 * 2.0 * math.pi / w * rate)):
        t = k / rate
        rows.append(
            {
                "time": t,
                "position": size / stiffness * math.cos(delay) * math.sin(w * t - delay)
                + noise.gauss(0.0, 2e-7),
                "torque": size * math.sin(w * t) + noise.gauss(0.0, 0.05),
                "load_torque": 0.0,
                "temperature": 35.0,
            }
        )
    return rows


MADE: dict[str, Callable[[], list[Row]]] = {
    made.__name__: made for made in (passes, arm, no_load, loaded, presliding)
}
