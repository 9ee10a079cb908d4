"""The reference trajectory: found by name, completed without a filter, left out where unusable."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from stribeck.recording.load import read
from stribeck.recording.motion.excerpt import excerpt
from stribeck.recording.naming.columns import parse_name


@pytest.mark.parametrize(
    ("name", "channel", "index"),
    [
        ("reference_position", "reference_position", None),
        ("q_ref_m", "reference_position", None),
        ("target_q_3", "reference_position", "3"),
        ("dq_ref", "reference_velocity", None),
        ("target_qd_radps", "reference_velocity", None),
        ("ddq_des", "reference_acceleration", None),
    ],
)
def test_names(name: str, channel: str, index: str | None) -> None:
    parsed = parse_name(name)
    assert (parsed.channel, parsed.index) == (channel, index)


def test_missing_channels_are_differentiated(
    frame: pl.DataFrame, write: Callable[..., Path]
) -> None:
    made = read(write(frame.with_columns(q_ref=pl.col("position"))))
    without = read(write(frame, "without.parquet"))
    inside = slice(10, -10)
    assert made.reference_velocity is not None and made.reference_acceleration is not None
    np.testing.assert_allclose(
        made.reference_acceleration[inside], frame["acceleration"].to_numpy()[inside], atol=1e-3
    )
    assert made.columns["reference_position"].source == "q_ref"
    assert without.reference_velocity is None
    np.testing.assert_array_equal(made.velocity, without.velocity)
    # The units of all columns are stated, those of the reference too.
    assert [n for n in made.notes if "assumed" not in n] == [
        n for n in without.notes if "assumed" not in n
    ]
    part = excerpt(made, 500)
    assert part.reference_velocity is not None and part.reference_velocity.size == part.rows


def test_a_reference_velocity_is_integrated(
    frame: pl.DataFrame, write: Callable[..., Path]
) -> None:
    made = read(write(frame.with_columns(reference_velocity=pl.col("velocity"))))
    assert made.reference_position is not None and made.position is not None
    np.testing.assert_allclose(made.reference_position, made.position, atol=1e-3)


def test_rigid_body_terms_follow_the_reference(
    frame: pl.DataFrame, write: Callable[..., Path]
) -> None:
    moved = frame.drop("load_torque").with_columns(
        reference_position=pl.col("position"), reference_acceleration=2.0 * pl.col("acceleration")
    )
    made = read(write(moved), inertia=0.5)
    assert made.reference_load_torque is not None
    np.testing.assert_allclose(made.reference_load_torque, frame["acceleration"].to_numpy())


def test_an_unusable_reference_is_left_out(frame: pl.DataFrame, write: Callable[..., Path]) -> None:
    """It changes neither the samples nor the units of the recording."""
    holes = pl.when(pl.col("time") < 1.0).then(None).otherwise(pl.col("position"))
    made = read(write(frame.with_columns(q_ref=holes)))
    assert made.reference_velocity is None and made.rows == frame.height
    assert any("reference_position ('q_ref') has empty" in note for note in made.notes)
    named = frame.rename({"velocity": "velocity_radps"}).with_columns(q_ref_m=pl.col("position"))
    made = read(write(named))
    assert made.reference_velocity is None and made.joint_kind == "revolute"
    assert any("another kind of joint" in note for note in made.notes)


def test_units_and_choice_of_columns(frame: pl.DataFrame, write: Callable[..., Path]) -> None:
    degrees = frame.with_columns(q_ref_deg=pl.col("position") * 180.0 / np.pi)
    made = read(write(degrees))
    assert made.reference_position is not None and made.position is not None
    np.testing.assert_allclose(made.reference_position, made.position)
    two = frame.with_columns(q_ref=pl.col("position"), q_des=2.0 * pl.col("position"))
    assert read(write(two)).reference_velocity is None
    chosen = read(write(two), map=["reference_position=q_des"])
    assert chosen.reference_position is not None and chosen.position is not None
    np.testing.assert_allclose(chosen.reference_position, 2.0 * chosen.position)


def test_the_joint_of_a_wide_file(frame: pl.DataFrame, write: Callable[..., Path]) -> None:
    wide = frame.select(
        "time",
        *(
            (k * pl.col(channel)).alias(f"{name}_{k}")
            for channel, name in (
                ("position", "q"),
                ("velocity", "qd"),
                ("torque", "tau"),
                ("position", "target_q"),
            )
            for k in (1, 2)
        ),
    )
    made = read(write(wide), joint="2")
    assert made.columns["reference_position"].source == "target_q_2"
    assert made.reference_position is not None and made.position is not None
    np.testing.assert_allclose(made.reference_position, made.position)
