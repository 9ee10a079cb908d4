"""What a recording cannot show, from recordings made so that they cannot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.testable import untestable
from synthetic import joint, motion, record


def answers(folder: Path, frame: pl.DataFrame, **options: object) -> dict[str, str]:
    """Effects that the recording cannot show, and why."""
    recording = record(folder, frame, **options)
    return {effect: row.why for effect, row in untestable(recording).items()}


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
    slow = {"constant": set(), "absent": set(), "three kelvin": {"drift"}}[change]
    assert set(found) == {"temperature_viscous", "temperature_dry", "thermometer_lag"} | slow
    assert "temperature" in found["temperature_dry"]
    assert all("temperature" in found[effect] for effect in slow)


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
    assert {"direction", "offset", "position", "presliding"} <= set(found)
    assert {"spring", "ripple"} <= set(found)
    assert "move forward" in found["direction"]
    assert "reversals" in found["presliding"]
    # Its speed varies, and slow motion is part of it.
    assert not {"inertia", "gravity", "stribeck"} & set(found)


@pytest.mark.parametrize("load", ["constant", "same sign"])
def test_load(tmp_path: Path, load: str) -> None:
    frame, v = joint(), motion()[2]
    given = np.full(v.size, 5.0) if load == "constant" else np.abs(v) * 4.0 * np.sign(v)
    found = answers(
        tmp_path,
        frame.with_columns(load_torque=pl.Series(given), torque=pl.Series(given + 3 * np.sign(v))),
    )
    unmoved = {"backlash", "elasticity"} if load == "constant" else set()
    assert set(found) == {"load", "quadrant", "gain", "saturation", "warm_up"} | unmoved
    assert ("varies too little" if load == "constant" else "sign") in found["load"]


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
    assert {"stribeck", "nonlinear_viscous", "frictional_lag"} <= set(found)
    assert "slower than" in found["stribeck"] and "speeds" in found["nonlinear_viscous"]


def test_prismatic_joint_and_small_range(tmp_path: Path) -> None:
    found = answers(tmp_path, joint(), joint_kind="prismatic")
    assert set(found) == {"gravity"} and "offset" in found["gravity"]
    _, q, v, a = motion()
    small = joint().with_columns(
        position=pl.Series(0.1 * q), velocity=pl.Series(0.1 * v), acceleration=pl.Series(0.1 * a)
    )
    found = answers(tmp_path, small)
    assert "rad" in found["gravity"] and "spring" not in found
    spring = 2.0 * small["position"]
    (first, *_) = sb.diagnose(
        sb.fit("coulomb", record(tmp_path, small.with_columns(torque=pl.col("torque") + spring)))
    ).findings
    assert first.effect == "spring" and "gravity" in first.indistinguishable_from


def test_a_load_that_is_not_known_beforehand(tmp_path: Path) -> None:
    found = answers(tmp_path, joint().drop("load_torque"))
    assert {"gain", "saturation", "quadrant", "elasticity"} <= set(found)
    assert "not known beforehand" in found["elasticity"]
    frame = joint()
    friction = frame["torque"] - frame["load_torque"]
    direct = frame.with_columns(friction_torque=friction).drop("torque")
    assert "motor torque itself" in answers(tmp_path, direct)["gain"]


def test_a_torque_that_is_always_the_same_size_shows_no_saturation(tmp_path: Path) -> None:
    frame, v = joint(), motion()[2]
    t = frame["time"].to_numpy()
    load = np.where((t // 3.7) % 2 == 0, 20.0, -25.0)
    found = answers(
        tmp_path,
        frame.with_columns(load_torque=pl.Series(load), torque=pl.Series(load + 3 * np.sign(v))),
    )
    assert "more than half of the largest" in found["saturation"] and "gain" not in found


def slower(frame: pl.DataFrame, times: float) -> pl.DataFrame:
    """The same way in so many times the time, without what hangs on acceleration."""
    return frame.with_columns(
        time=pl.col("time") * times,
        velocity=pl.col("velocity") / times,
        acceleration=pl.col("acceleration") / times**2,
    )


def test_slow_changes_of_speed_show_no_lag(tmp_path: Path) -> None:
    found = answers(tmp_path, slower(joint(), 100.0))
    assert "enough to pass its slow speeds" in found["frictional_lag"] and "stribeck" not in found


def test_a_load_that_never_turns_shows_no_backlash(tmp_path: Path) -> None:
    q = motion()[1]
    heavy = 40.0 + 9.0 * np.sin(q)
    frame = joint().with_columns(load_torque=pl.Series(heavy), torque=pl.Series(heavy + 3.0))
    found = answers(tmp_path, frame)
    assert "changes its sign 0 times" in found["backlash"]


def test_a_load_that_is_not_known_shows_no_backlash(tmp_path: Path) -> None:
    """Friction that was measured directly says nothing of the load."""
    frame = joint().drop("load_torque").rename({"torque": "friction_torque"})
    assert "the load torque is not known" in answers(tmp_path, frame)["backlash"]


def test_a_slow_load_shows_no_elasticity(tmp_path: Path) -> None:
    slow = 6.0 * np.sin(motion()[1])
    frame = slower(joint(), 10.0).with_columns(load_torque=pl.Series(slow))
    assert "look rigid" in answers(tmp_path, frame)["elasticity"]


def test_samples_too_far_apart_show_no_ripple(tmp_path: Path) -> None:
    """Sixteen samples of each pass to and fro."""
    t = 0.5 * np.arange(1200)
    w = 2.0 * np.pi / 8.1
    v = w * np.cos(w * t)
    frame = pl.DataFrame(
        {"time": t, "position": np.sin(w * t), "velocity": v, "torque": np.sign(v)}
    )
    assert "too far apart" in answers(tmp_path, frame)["ripple"]


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
    assert {"gain", "saturation", "spring", "ripple", "drift"} <= set(found)
    assert {"frictional_lag", "backlash", "elasticity"} <= set(found)
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
    assert "passed only 2.0 times" in found["position"] and "1 reversal" in found["presliding"]
    # The periods of a ripple are passed more often.
    assert "spring" in found and "ripple" not in found


def test_a_torque_that_is_mostly_large_may_show_saturation(tmp_path: Path) -> None:
    """A weight turned by a quarter: most of its torques are above half of the largest."""
    found = answers(tmp_path, joint().with_columns(torque=6.0 * (1.3 * pl.col("position")).cos()))
    assert "saturation" not in found
