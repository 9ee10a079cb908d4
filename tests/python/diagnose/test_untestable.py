"""What a recording cannot show, from recordings made so that they cannot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnose.testable import CHECKS, untestable
from stribeck.model import effect_ids
from synthetic import joint, motion, record

EVERYTHING = set(effect_ids())


def answers(folder: Path, frame: pl.DataFrame, **options: object) -> dict[str, str]:
    """Effects that the recording cannot show, and why."""
    recording = record(folder, frame, **options)
    return {effect: row.why for effect, row in untestable(recording).items()}


def test_every_effect_has_a_check() -> None:
    assert set(CHECKS) == EVERYTHING


def test_a_rich_recording_shows_everything(plain: sb.Recording) -> None:
    assert untestable(plain) == {}


def test_answers_say_what_to_do(tmp_path: Path) -> None:
    recording = record(tmp_path, joint().drop("temperature"))
    for effect, row in untestable(recording).items():
        said = row.to_dict()
        assert set(said) == {"effect", "why", "do"} and said["effect"] == effect
        assert len(said["why"]) > 10 and len(said["do"]) > 10


@pytest.mark.parametrize("change", ["absent", "constant", "three kelvin"])
def test_temperature(tmp_path: Path, change: str) -> None:
    frame = joint()
    if change == "absent":
        frame = frame.drop("temperature")
    elif change == "constant":
        frame = frame.with_columns(temperature=pl.lit(30.0))
    else:
        frame = frame.with_columns(temperature=30.0 + pl.col("time") / 10.0)
    found = answers(tmp_path, frame)
    assert set(found) == {"temperature_viscous", "temperature_dry"}
    assert "temperature" in found["temperature_dry"]


def test_one_direction(tmp_path: Path) -> None:
    frame = joint()
    t = frame["time"].to_numpy()
    v = 0.6 + 0.55 * np.sin(1.3 * t)
    found = answers(
        tmp_path,
        frame.with_columns(
            velocity=pl.Series(v),
            position=pl.Series(0.6 * t - 0.55 / 1.3 * np.cos(1.3 * t)),
            acceleration=pl.Series(0.55 * 1.3 * np.cos(1.3 * t)),
        ),
    )
    assert {"direction", "offset", "stribeck", "position", "presliding"} <= set(found)
    assert "forward only" in found["direction"]
    assert "reversals" in found["presliding"]
    assert "inertia" not in found and "gravity" not in found


@pytest.mark.parametrize("load", ["constant", "same sign"])
def test_load(tmp_path: Path, load: str) -> None:
    frame, v = joint(), motion()[2]
    given = np.full(v.size, 5.0) if load == "constant" else np.abs(v) * 4.0 * np.sign(v)
    found = answers(
        tmp_path,
        frame.with_columns(load_torque=pl.Series(given), torque=pl.Series(given + 3 * np.sign(v))),
    )
    # What the load cannot show, a difference between its quadrants cannot either.
    assert set(found) == {"load", "quadrant"}
    assert ("hardly varies" if load == "constant" else "sign") in found["load"]


def test_no_slow_motion(tmp_path: Path) -> None:
    """Constant speeds of 0.9 to 1.1 rad/s in both directions."""
    frame = joint()
    t = frame["time"].to_numpy()
    sign = np.where((t // 1.5) % 2 == 0, 1.0, -1.0)
    speed = 1.0 + 0.1 * np.sin(0.37 * t)
    v = sign * speed
    found = answers(
        tmp_path,
        frame.with_columns(velocity=pl.Series(v), position=pl.Series(np.cumsum(v) * 0.01)).drop(
            "acceleration"
        ),
    )
    assert {"stribeck", "nonlinear_viscous"} <= set(found)
    assert "slower than" in found["stribeck"] and "speeds" in found["nonlinear_viscous"]


def test_prismatic_joint_and_small_range(tmp_path: Path) -> None:
    found = answers(tmp_path, joint(), joint_kind="prismatic")
    assert set(found) == {"gravity"} and "offset" in found["gravity"]
    _, q, v, a = motion()
    small = joint().with_columns(
        position=pl.Series(0.1 * q), velocity=pl.Series(0.1 * v), acceleration=pl.Series(0.1 * a)
    )
    assert "rad" in answers(tmp_path, small)["gravity"]


def test_steady_points(tmp_path: Path) -> None:
    """Medians of constant speeds hold neither reversals nor acceleration nor timing."""
    v = np.repeat(np.concatenate([np.linspace(0.05, 2, 12), np.linspace(-2, -0.05, 12)]), 3)
    frame = pl.DataFrame(
        {
            "run": np.repeat(np.arange(24), 3),
            "time": np.tile([0.0, 0.1, 0.2], 24),
            "velocity": v + 1e-5 * np.random.default_rng(0).standard_normal(v.size),
            "torque": 3 * np.sign(v) + 2 * v,
            "load_torque": np.zeros(v.size),
        }
    )
    found = answers(tmp_path, frame, average="run")
    assert {"presliding", "inertia", "delay", "position", "gravity", "load"} <= set(found)
    assert not {"stribeck", "direction", "offset", "nonlinear_viscous"} & set(found)


def test_one_pass_of_the_stroke(tmp_path: Path) -> None:
    t = joint()["time"].to_numpy()
    w = 2 * np.pi / t[-1]
    once = joint().with_columns(
        position=pl.Series(-np.cos(w * t)),
        velocity=pl.Series(w * np.sin(w * t)),
        acceleration=pl.Series(w**2 * np.cos(w * t)),
    )
    found = answers(tmp_path, once)
    assert "passed 2.0 times" in found["position"] and "reversals" in found["presliding"]
