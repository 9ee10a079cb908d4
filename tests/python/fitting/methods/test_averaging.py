"""Friction from passes in both directions, without a gravity model."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import passes
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.methods.averaging import averaged_points
from stribeck.fitting.methods.grid import grid_fit

SPEEDS = [0.02, 0.05, 0.08, 0.15, 0.3, 0.6, 1.0, 1.5]


def read(folder: Path, frame: pl.DataFrame) -> sb.Recording:
    path = folder / "passes.parquet"
    frame.write_parquet(path)
    return sb.read(path, joint_kind="revolute", standstill=True)


def test_friction_comes_back_to_the_noise_and_gravity_stays_out(tmp_path: Path) -> None:
    recording = read(tmp_path, passes.log(SPEEDS))
    points = averaged_points(recording)
    assert len(points) == len(SPEEDS)
    assert points.velocity == pytest.approx(SPEEDS, rel=2e-3)
    true = passes.friction(points.velocity)
    errors = np.array([p.friction_stderr for p in points.points])
    assert np.all(np.abs(points.friction_torque - true) < 4.0 * errors + 1e-3)
    # Gravity is several times the friction, and its mean over a pass is what is left of it.
    loads = [p.load_torque for p in points.points]
    assert min(loads) > 10.0 and np.ptp(loads) < 1.0
    assert np.all(np.diff([p.temperature for p in points.points]) > 0)


def test_the_curve_behind_the_points_is_identified(tmp_path: Path) -> None:
    averaged_points(read(tmp_path, passes.log(SPEEDS))).write(tmp_path / "points.csv")
    fit = sb.fit("coulomb+stribeck", sb.read(tmp_path / "points.csv"))
    assert fit.model.value("coulomb_friction") == pytest.approx(passes.COULOMB, rel=0.02)
    assert fit.model.value("viscous_friction") == pytest.approx(passes.VISCOUS, rel=0.02)
    assert fit.rmse < passes.TORQUE_NOISE


def test_bins_show_friction_that_grows_with_the_load(tmp_path: Path) -> None:
    frame = passes.log([0.3, 0.6, 1.0], stroke=1.7, load_share=0.1)
    points = averaged_points(read(tmp_path, frame), bins=6)
    assert len(points) == 18
    load = np.array([p.load_torque for p in points.points])
    beyond = points.friction_torque - passes.friction(points.velocity)
    share = float(load @ beyond) / float(load @ load)
    assert np.ptp(load) > 5.0
    assert share == pytest.approx(0.1, rel=0.02)


def test_a_pass_without_counterpart_is_left_out_and_said(tmp_path: Path) -> None:
    frame = passes.log([0.3, 0.6])
    # The last pass backward is cut off: its partner forward stands alone.
    last = frame["time"][-1] - 0.8 / 0.6 - 0.8
    points = averaged_points(read(tmp_path, frame.filter(pl.col("time") < last)))
    assert len(points) == 1
    assert any("1 pass has no counterpart" in note for note in points.notes)


def test_passes_in_one_direction_alone_are_refused(tmp_path: Path) -> None:
    frame = passes.log([0.3])
    forward = frame.filter(pl.col("time") < 0.4 + 0.2 + 0.8 / 0.3)
    with pytest.raises(FitError, match="1 forward and 0 backward passes"):
        averaged_points(read(tmp_path, forward))


def test_passes_over_other_positions_are_refused(tmp_path: Path) -> None:
    frame = passes.log([0.3])
    half = frame.height // 2
    moved = pl.concat([frame[:half], frame[half:].with_columns(position=pl.col("position") + 3.0)])
    with pytest.raises(FitError, match="no two at the same speed over the same positions"):
        averaged_points(read(tmp_path, moved))


def test_no_bins_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FitError, match="`bins=0`"):
        averaged_points(read(tmp_path, passes.log([0.3])), bins=0)


def test_a_law_with_load_is_identified_from_bins(tmp_path: Path) -> None:
    """M1 of the paper: the load torque that it needs is half the sum of both directions."""
    frame = passes.log([*SPEEDS], stroke=1.7, load_share=0.1)
    averaged_points(read(tmp_path, frame), bins=6).write(tmp_path / "points.csv")
    law = sb.model("m1", constants={"stribeck_exponent": 2.0})
    fit = grid_fit(law, sb.read(tmp_path / "points.csv"))
    assert fit.model.value("load_coulomb") == pytest.approx(0.1, rel=0.05)
    assert fit.model.value("coulomb_friction") == pytest.approx(passes.COULOMB, rel=0.02)
    assert fit.model.value("stribeck_velocity") == pytest.approx(passes.STRIBECK_VELOCITY, rel=0.05)
