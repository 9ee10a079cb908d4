"""The channels of a second encoder on the motor's shaft."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb

from ..conftest import DATA

Write = Callable[..., Path]


def test_the_motor_is_seen_at_the_joint_side(write: Write, frame: pl.DataFrame) -> None:
    both = frame.with_columns(
        motor_position=100.0 * (pl.col("position") + 0.001) + 3.0,
        motor_speed=100.0 * pl.col("velocity"),
    )
    recording = sb.read(write(both), gear_ratio=100.0)
    assert recording.motor_position is not None and recording.motor_velocity is not None
    assert recording.motor_position == pytest.approx(recording.position + 0.031)
    assert recording.motor_velocity == pytest.approx(recording.velocity)
    assert recording.columns["motor_position"].unit == "rad"
    assert any(
        "motor_position is divided by 100 (both encoders: 1.00000" in n for n in recording.notes
    )


def test_a_drive_may_have_divided_already(write: Write, frame: pl.DataFrame) -> None:
    both = frame.with_columns(motor_position=pl.col("position"))
    recording = sb.read(write(both), gear_ratio=100.0)
    assert recording.motor_position == pytest.approx(recording.position)


def test_a_ratio_that_is_not_known_is_said(write: Write, frame: pl.DataFrame) -> None:
    both = frame.with_columns(motor_position=50.0 * pl.col("position"))
    recording = sb.read(write(both), gear_ratio=100.0)
    assert recording.motor_position is None and "motor_position" not in recording.columns
    (note,) = [n for n in recording.notes if n.startswith("motor_position")]
    assert "moves 50 times as far as the joint and is left out" in note


def test_a_motor_alone_is_the_joint(write: Write, frame: pl.DataFrame) -> None:
    alone = frame.select("time", "torque", motor_position="position", motor_velocity="velocity")
    recording = sb.read(write(alone))
    assert recording.columns["position"].source == "motor_position"
    assert recording.columns["velocity"].source == "motor_velocity"
    assert recording.motor_position is None


def test_missing_cells_of_the_motor_cost_no_samples(write: Write, frame: pl.DataFrame) -> None:
    holed = frame.with_columns(
        motor_position=pl.when(pl.int_range(pl.len()) == 7).then(None).otherwise("position")
    )
    recording = sb.read(write(holed))
    assert recording.rows == frame.height and recording.motor_position is None
    assert any("has empty, NaN or infinite cells" in note for note in recording.notes)


@pytest.mark.skipif(not DATA.is_dir(), reason="published measurements are not there")
def test_the_industrial_robot_has_two_encoders() -> None:
    names = "time=time_cont position=act_pos_se_deg_1 motor_position=act_pos_mot_deg_1"
    recording = sb.read(
        DATA / "kr300" / "A.mat",
        map=[
            *names.split(),
            "torque=act_torque_abs_nm_1",
            "velocity=act_vel_se_deg_per_s_1",
        ],
        gear_ratio=256.857,
        torque_at="motor",
        trust=True,
    )
    assert recording.motor_position is not None
    windup = recording.motor_position - recording.position
    assert 0.0 < abs(windup).max() < 0.01
