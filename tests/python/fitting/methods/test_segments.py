"""The static friction map of the gantry's ball screw, from displacement and force."""

from __future__ import annotations

from pathlib import Path

import gantry
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import FitError
from stribeck.fitting.methods.segments import segment_points
from stribeck.fitting.methods.stretches import Search

SPEEDS = [
    0.0005,
    0.001,
    0.0015,
    0.002,
    0.003,
    0.004,
    0.006,
    0.01,
    0.02,
    0.05,
    0.1,
    0.15,
    0.2,
]


def read(folder: Path, frame: pl.DataFrame, **options: object) -> sb.Recording:
    path = folder / "log.parquet"
    frame.write_parquet(path)
    return sb.read(path, **{"joint_kind": "prismatic", "standstill": True, **options})


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """Passes of the gantry both ways, with sensor noise and quantisation."""
    return read(tmp_path_factory.mktemp("gantry"), gantry.displacement_log(SPEEDS))


def test_the_stand_has_the_mass_of_table_1() -> None:
    assert gantry.equivalent_mass() == pytest.approx(23.0530, rel=1e-3)


def test_the_map_of_table_1_comes_back_in_both_directions(
    log: sb.Recording, tmp_path: Path
) -> None:
    points = segment_points(log)
    assert np.sum(points.velocity > 0) >= 12 and np.sum(points.velocity < 0) >= 12
    points.write(tmp_path / "points.csv")
    fit = sb.fit("gantry_map", sb.read(tmp_path / "points.csv"))
    truth = {
        "coulomb_friction": gantry.COULOMB,
        "static_friction": gantry.STATIC,
        "stribeck_velocity": gantry.STRIBECK,
        "viscous_friction_forward": gantry.FORWARD,
        "viscous_friction_backward": gantry.BACKWARD,
    }
    for name, value in truth.items():
        assert fit.model.value(name) == pytest.approx(value, rel=0.02), name


def test_a_law_with_a_bristle_slides_at_steady_points(log: sb.Recording, tmp_path: Path) -> None:
    segment_points(log).write(tmp_path / "points.csv")
    fit = sb.fit("lugre", sb.read(tmp_path / "points.csv"))
    # LuGre has one viscous coefficient for both directions; the rest of the map is the same.
    assert fit.model.value("coulomb_friction") == pytest.approx(gantry.COULOMB, rel=0.03)
    assert fit.model.value("static_friction") == pytest.approx(gantry.STATIC, rel=0.03)
    assert gantry.FORWARD < fit.model.value("viscous_friction") < gantry.BACKWARD


def test_points_lie_on_the_map_to_their_own_errors(log: sb.Recording) -> None:
    for point in segment_points(log).points:
        true = gantry.friction(point.velocity)
        # The map falls by 0.9 N per um/s at its steepest: the error of the speed counts too.
        error = np.hypot(point.friction_stderr, 8.6e5 * point.velocity_stderr)
        assert point.friction_torque == pytest.approx(true, abs=5.0 * error + 1e-4 * gantry.COULOMB)


def test_a_known_load_is_taken_off_and_kept(tmp_path: Path) -> None:
    frame = gantry.displacement_log([0.05, 0.1]).with_columns(
        torque=pl.col("torque") + 500.0, load_torque=pl.lit(500.0)
    )
    points = segment_points(read(tmp_path, frame))
    for point in points.points:
        assert point.load_torque == 500.0
        assert point.friction_torque == pytest.approx(gantry.friction(point.velocity), rel=1e-3)
    points.write(tmp_path / "points.csv")
    again = sb.read(tmp_path / "points.csv")
    assert again.load_torque is not None and set(again.load_torque) == {500.0}
    assert again.torque - again.load_torque == pytest.approx(points.friction_torque)


def test_bins_follow_a_load_that_changes_along_a_pass(tmp_path: Path) -> None:
    frame = gantry.displacement_log([0.05, 0.1])
    load = 4000.0 * pl.col("position")
    frame = frame.with_columns(torque=pl.col("torque") + load, load_torque=load)
    points = segment_points(read(tmp_path, frame), bins=5)
    assert len(points) == 20
    forward = [p for p in points.points[:5] if p.load_torque is not None]
    assert np.all(np.diff([p.load_torque for p in forward]) > 100.0)
    for point in points.points:
        assert point.friction_torque == pytest.approx(gantry.friction(point.velocity), rel=2e-3)
    with pytest.raises(FitError, match="`bins=0`"):
        segment_points(read(tmp_path, frame), bins=0)


def test_motion_without_constant_speed_is_refused(tmp_path: Path) -> None:
    time = np.arange(0.0, 10.0, 0.005)
    frame = pl.DataFrame(
        {"time": time, "position": 0.2 * np.sin(time) ** 3, "torque": np.cos(time)}
    )
    with pytest.raises(FitError, match=r"no interval of constant speed to 2 % over 1 s"):
        segment_points(read(tmp_path, frame), search=Search(tolerance=0.02, shortest=1.0))


def test_a_log_without_position_is_refused(tmp_path: Path) -> None:
    frame = gantry.displacement_log([0.1]).with_columns(
        velocity=pl.col("position").diff().fill_null(0.0) * 500.0
    )
    with pytest.raises(FitError, match="no position column"):
        segment_points(read(tmp_path, frame.drop("position")))


@pytest.mark.parametrize(
    ("search", "said"),
    [
        (Search(tolerance=0.0), "`tolerance=0`"),
        (Search(shortest=-1.0), "`shortest=-1`"),
        (Search(trim=0.5), "`trim=0.5`"),
    ],
)
def test_options_out_of_range_are_refused(log: sb.Recording, search: Search, said: str) -> None:
    with pytest.raises(FitError, match=said):
        segment_points(log, search=search)
