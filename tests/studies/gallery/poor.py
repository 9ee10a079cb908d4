"""Recordings that lack something each, for the motions and sensors that effects ask for."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.diagnosis.testable import untestable
from stribeck.effect.base import Obstacle
from stribeck.motion.generate.hidden import generate

#: Of a single pass: speed in rad/s, duration in s, rate in Hz.
SPEED, SECONDS, RATE = 0.3, 5.0, 100.0


def one_pass() -> sb.Recording:
    """One pass at one speed, in one direction, with one load."""
    return sb.read(_pass(SECONDS))


def without_load() -> sb.Recording:
    """No load torque, and no temperature."""
    return sb.read(_rich().drop("load_torque", "temperature"))


def without_position() -> sb.Recording:
    """No position."""
    return sb.read(_rich().drop("position"))


def friction_alone() -> sb.Recording:
    """Friction that was measured without the load."""
    friction = pl.col("torque") - pl.col("load_torque")
    return sb.read(_rich().with_columns(friction_torque=friction).drop("torque"))


def warming_only() -> sb.Recording:
    """The joint warms up and does not cool down."""
    return sb.read(_rich().filter(pl.col("time") < 60.0))


def fast_only() -> sb.Recording:
    """No slow passes, and no oscillations."""
    return sb.read(_pass(SECONDS, turns=3))


def steady_points() -> sb.Recording:
    """Medians of passes at constant speed."""
    whole = _pass(SECONDS, turns=8).with_columns(run=pl.col("time").floordiv(SECONDS))
    return sb.read(whole, average="run")


def prismatic() -> sb.Recording:
    """A joint that slides."""
    frame, _ = generate((), seed=1, seconds=60.0, rate=100.0, joint_kind="prismatic")
    return sb.read(frame, joint_kind="prismatic")


POOR: tuple[Callable[[], sb.Recording], ...] = (
    one_pass,
    without_load,
    without_position,
    friction_alone,
    warming_only,
    fast_only,
    steady_points,
    prismatic,
)


def obstacles() -> dict[str, list[Obstacle]]:
    """For each effect, why one of the recordings cannot show it, and what would."""
    found: dict[str, list[Obstacle]] = {}
    for make in POOR:
        for effect, row in untestable(make()).items():
            rows = found.setdefault(effect, [])
            if all(_same(row.why) != _same(other.why) for other in rows):
                rows.append(Obstacle(row.why, row.do))
    return found


def _same(sentence: str) -> str:
    """A sentence without its numbers."""
    return re.sub(r"[\d.]+", "", sentence)


def _rich() -> pl.DataFrame:
    return generate((), seed=1, seconds=120.0, rate=100.0)[0]


def _pass(seconds: float, turns: int = 1) -> pl.DataFrame:
    """Fast passes, back and forth, with the same load and temperature."""
    n = round(seconds * RATE)
    rng = np.random.default_rng(1)
    way = np.repeat([(-1.0) ** k * (1.0 + 0.1 * k) for k in range(turns)], n)
    noise = rng.standard_normal((4, way.size))
    return pl.DataFrame(
        {
            "time": np.arange(way.size) / RATE,
            "position": np.cumsum(SPEED * way) / RATE,
            "velocity": SPEED * way + 1e-3 * noise[0],
            "torque": 30.0 + 8.0 * np.sign(way) + 0.1 * noise[1],
            "load_torque": np.full(way.size, 30.0),
            "temperature": 24.0 + 0.05 * noise[2],
        }
    )
