"""Fits of data sets, a window at a time, against the same fits in memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.signal import lfilter
from synthetic import joint, sticking_joint

EVERYTHING = 10**9


def written(folder: Path, frame: pl.DataFrame, files: int = 3) -> Path:
    """The frame in several files of a folder."""
    folder.mkdir()
    size = -(-frame.height // files)
    for k in range(files):
        frame.slice(k * size, size).write_parquet(folder / f"{k}.parquet", row_group_size=700)
    return folder


def in_memory(folder: Path, frame: pl.DataFrame, spec: str, **reading: object) -> sb.Fit:
    path = folder / "whole.parquet"
    frame.write_parquet(path)
    return sb.fit(spec, sb.read(path, **reading))


def test_a_linear_model_takes_one_pass_and_is_the_same_as_in_memory(tmp_path: Path) -> None:
    frame = joint(rows=12_000)
    folder = written(tmp_path / "set", frame)
    opened = sb.stream(folder, sample_rows=EVERYTHING, window_rows=1001)
    streamed, whole = opened.fit("coulomb"), in_memory(tmp_path, frame, "coulomb")
    assert streamed.passes == 1
    assert streamed.moving == whole.recording.moving.sum()
    for name, estimate in whole.estimates.items():
        assert streamed.estimates[name].value == pytest.approx(estimate.value, rel=1e-11)
    assert streamed.rmse == pytest.approx(whole.rmse, rel=1e-11)
    # Blocks are of equal rows here and of equal time there: a row may change sides at a border.
    assert streamed.rmse_held_out == pytest.approx(whole.rmse_held_out, rel=1e-6)
    assert streamed.model.box["velocity"] == whole.model.box["velocity"]
    said = streamed.to_dict()
    assert said["determined_combinations"] == []
    assert said["correlation"]["parameters"] == ["viscous_friction", "coulomb_friction"]
    one, other = (fit.covariance.correlation().values[0, 1] for fit in (streamed, whole))
    assert one == pytest.approx(other, abs=0.2)


def test_a_current_is_a_torque_in_every_window(tmp_path: Path) -> None:
    frame = joint(rows=6000)
    driven = frame.with_columns(current_A=pl.col("torque") / 20.0).drop("torque")
    drive = {"torque_constant": 2.0, "gear_ratio": 10.0, "map": ["load_torque=none"]}
    folder = written(tmp_path / "set", driven)
    streamed = sb.stream(folder, window_rows=1001, **drive).fit("coulomb")
    whole = in_memory(tmp_path, driven, "coulomb", **drive)
    for name, estimate in whole.estimates.items():
        assert streamed.estimates[name].value == pytest.approx(estimate.value, rel=1e-9)


def test_in_one_direction_the_sum_with_an_offset_is_determined(tmp_path: Path) -> None:
    frame = joint(rows=6000)
    forward = frame.with_columns(
        velocity=pl.col("velocity").abs(),
        torque=pl.when(pl.col("velocity") < 0)
        .then(2 * pl.col("load_torque") - pl.col("torque"))
        .otherwise(pl.col("torque")),
    ).drop("position", "acceleration")
    folder = written(tmp_path / "set", forward)
    streamed = sb.stream(folder, sample_rows=EVERYTHING).fit("coulomb+offset")
    (one,) = streamed.combinations
    assert one.text == "coulomb_friction + offset"
    assert one.value == pytest.approx(3.0, abs=5.0 * one.stderr)
    assert "Only this combination is determined: coulomb_friction + offset" in repr(streamed)


def test_a_curved_model_ends_where_it_does_in_memory(tmp_path: Path) -> None:
    curve = joint(rows=12_000)
    v = curve["velocity"].to_numpy()
    hidden = 1.5 * np.exp(-(np.abs(v / 0.15) ** 1.3)) * np.sign(v)
    frame = curve.with_columns(torque=pl.col("torque") + hidden)
    folder = written(tmp_path / "set", frame)
    opened = sb.stream(folder, sample_rows=4000, window_rows=1001)
    assert not opened.sample.whole
    streamed = opened.fit("coulomb+stribeck")
    whole = in_memory(tmp_path, frame, "coulomb+stribeck")
    assert streamed.converged and streamed.passes > 1
    for name, estimate in whole.estimates.items():
        assert estimate.stderr is not None
        assert abs(streamed.estimates[name].value - estimate.value) < 0.05 * estimate.stderr
    assert streamed.rmse_held_out == pytest.approx(whole.rmse_held_out, rel=1e-3)


@pytest.mark.parametrize(
    "spec", ["coulomb", "coulomb+presliding", "coulomb+delay", "coulomb+drift"]
)
def test_what_a_window_needs_of_its_neighbours_is_there(tmp_path: Path, spec: str) -> None:
    """Derived channels, states and elapsed time do not see where a window begins."""
    frame = joint(rows=12_000).drop("acceleration", "load_torque")
    options = {"joint_kind": "revolute"}
    folder = written(tmp_path / "set", frame)
    opened = sb.stream(folder, sample_rows=EVERYTHING, window_rows=5001, **options)
    streamed = opened.fit(spec, starts=2)
    whole = in_memory(tmp_path, frame, spec, **options)
    assert streamed.model.rigid_body == whole.model.rigid_body == ("inertia", "gravity")
    assert streamed.rmse == pytest.approx(whole.rmse, rel=1e-4)
    assert streamed.rmse_held_out == pytest.approx(whole.rmse_held_out, rel=1e-3)
    for name in ("coulomb_friction", "inertia", "gravity_sin"):
        estimate = whole.estimates[name]
        assert estimate.stderr is not None
        assert abs(streamed.estimates[name].value - estimate.value) < 0.1 * estimate.stderr


def test_windows_change_nothing_but_rounding(tmp_path: Path) -> None:
    folder = written(tmp_path / "set", joint(rows=12_000))
    fits = [
        sb.stream(folder, sample_rows=3000, window_rows=size).fit("coulomb")
        for size in (500, 1024, 20_000)
    ]
    values = np.array([fit.model.values for fit in fits])
    assert np.ptp(values, axis=0) == pytest.approx(0.0, abs=1e-11)
    errors = np.array([[e.stderr for e in fit.estimates.values()] for fit in fits])
    assert np.ptp(errors, axis=0) == pytest.approx(0.0, abs=1e-9)


def test_standard_errors_know_that_noise_is_correlated(tmp_path: Path) -> None:
    """Correlated noise of the same size leaves larger errors, about those in memory."""
    sizes = {}
    for rho in (0.0, 0.95):
        frame = joint(rows=24_000, rho=rho, noise=0.2)
        folder = written(tmp_path / f"set {rho}", frame)
        streamed = sb.stream(folder, sample_rows=6000).fit("coulomb")
        whole = in_memory(tmp_path, frame, "coulomb")
        error = streamed.estimates["coulomb_friction"].stderr
        known = whole.estimates["coulomb_friction"].stderr
        assert error == pytest.approx(known, rel=0.35)
        sizes[rho] = error
    assert sizes[0.95] > 3.0 * sizes[0.0]


def test_a_held_parameter_stays(tmp_path: Path) -> None:
    folder = written(tmp_path / "set", joint(rows=6000))
    fitted = sb.stream(folder).fit("coulomb", fix={"viscous_friction": 0.5})
    assert fitted.model.value("viscous_friction") == 0.5
    assert fitted.estimates["viscous_friction"].held


def test_options_of_reading_are_kept(tmp_path: Path) -> None:
    """Formulas, units and conditions hold in every window."""
    frame = joint(rows=12_000)
    changed = frame.select(
        "time",
        "position",
        "acceleration",
        "load_torque",
        velocity_rpm=pl.col("velocity") * 30.0 / np.pi,
        current=pl.col("torque") / 4.0,
        ok=pl.col("time") % 10.0 < 7.0,
    )
    folder = written(tmp_path / "set", changed)
    options = {"derive": ["torque=current*4"], "where": "ok"}
    streamed = sb.stream(folder, sample_rows=3000, window_rows=512, **options).fit("coulomb")
    whole = in_memory(tmp_path, changed, "coulomb", **options)
    for name, estimate in whole.estimates.items():
        assert estimate.stderr is not None
        assert abs(streamed.estimates[name].value - estimate.value) < 0.05 * estimate.stderr
    assert streamed.rows == pytest.approx(0.7 * 12_000, abs=10)


def test_a_late_velocity_is_that_of_the_position_in_every_window(tmp_path: Path) -> None:
    frame = joint(rows=6000)
    share = 0.01 / 0.035
    v = frame["velocity"].to_numpy()
    late = lfilter([share], [1.0, share - 1.0], v, zi=[(1.0 - share) * v[0]])[0]
    late_frame = frame.with_columns(velocity=late)
    folder = written(tmp_path / "set", late_frame)
    streamed = sb.stream(folder, sample_rows=EVERYTHING, window_rows=1001).fit("coulomb")
    whole = in_memory(tmp_path, late_frame, "coulomb")
    assert whole.recording.columns["velocity"].derived
    for name, estimate in whole.estimates.items():
        assert streamed.estimates[name].value == pytest.approx(estimate.value, rel=1e-3)


def test_each_motion_is_filtered_by_itself_in_every_window(tmp_path: Path) -> None:
    """A motion that a window cuts has its own filter where that ends, not where the window does."""
    frame = sticking_joint()
    folder = written(tmp_path / "set", frame)
    opened = sb.stream(folder, sample_rows=EVERYTHING, window_rows=1001, joint_kind="revolute")
    streamed = opened.fit("coulomb")
    whole = in_memory(tmp_path, frame, "coulomb", joint_kind="revolute")
    chosen = whole.recording.acceleration_filter
    assert chosen is not None and chosen.at_ends is not None
    for name, estimate in whole.estimates.items():
        assert estimate.stderr is not None
        assert abs(streamed.estimates[name].value - estimate.value) < 1e-3 * estimate.stderr
