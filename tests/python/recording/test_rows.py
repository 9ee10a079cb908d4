"""Runs, gaps, dropped rows, noise, moving rows, blocks, derived channels."""

from __future__ import annotations

import time as clock
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read
from stribeck.recording.rows import noise_level, quantisation_step

from .conftest import joint


def test_gap_and_where_start_segments(write, frame):
    cut = frame.with_row_index().filter(~pl.col("index").is_between(500, 599)).drop("index")
    recording = read(write(cut))
    assert recording.gaps == 1 and recording.segment[-1] == 1
    assert recording.dt[500] == 0.0 and recording.dt[0] == 0.0
    assert recording.dt[499] == pytest.approx(0.005)
    # One removed row is a gap too, although its step is short.
    one = read(write(frame), where="not (time > 4.9999 and time < 5.0001)")
    assert len(one) == 1999 and one.gaps == 1
    assert "1 sample removed by where: not (time > 4.9999 and time < 5.0001)" in one.notes
    with pytest.raises(RecordingError, match=r"keeps none of 2000 rows"):
        read(write(frame), where="time > 1e9")


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), None])
def test_few_bad_rows_are_left_out(write, frame, bad):
    """Only a stretch of them is a gap, as where no rows were written."""
    torque = frame["torque"].to_list()
    for i in (100, 101, 700, *range(900, 906)):
        torque[i] = bad
    recording = read(write(frame.with_columns(torque=pl.Series(torque))))
    assert recording.rows_dropped == 9 and len(recording) == 1991 and recording.gaps == 1
    assert any("9 of 2000 rows" in n and "row 101, column 'torque'" in n for n in recording.notes)
    never = read(write(frame.with_row_index().filter(~pl.col("index").is_in([100, 101, 700]))))
    assert never.gaps == 0


def test_many_bad_rows_are_refused(write, frame):
    table = frame.with_columns(
        torque=pl.when(pl.int_range(pl.len()) % 10 == 3).then(None).otherwise("torque")
    )
    with pytest.raises(
        RecordingError,
        match=r"200 of 2000 rows have empty, NaN or infinite cells.*'torque', first in row 4",
    ):
        read(write(table))
    table = frame.with_columns(
        temperature=pl.when(pl.int_range(pl.len()) % 10 == 3).then("temperature")
    )
    with pytest.raises(RecordingError, match=r'`map="temperature=none"`'):
        read(write(table))
    recording = read(write(frame.with_columns(temperature=pl.lit(None, dtype=pl.Float64))))
    assert recording.temperature is None and any("is empty" in n for n in recording.notes)


def test_text_in_a_number_column(write, frame):
    lines = frame.head(100).write_csv().splitlines()
    cells = lines[18].split(",")
    cells[4] = "oops"
    lines[18] = ",".join(cells)
    path = write("\n".join(lines), "bad.csv")
    sentence = r"bad.csv: row 18 \(line 19\), column 'torque': 'oops' is not a number"
    with pytest.raises(RecordingError, match=sentence):
        read(path)
    with pytest.raises(RecordingError, match=sentence):
        read(path, derive=("friction_torque=torque*2",))


def test_time_must_increase(write, frame):
    back = pl.concat([frame.head(100), frame.head(100)])
    with pytest.raises(
        RecordingError,
        match=r"row 101, column 'time': time runs backwards from 0.495 to 0 s.*`map=.run=COLUMN.`",
    ):
        read(write(back))
    named = back.with_columns(file=pl.Series(["a"] * 100 + ["b"] * 100))
    with pytest.raises(RecordingError, match=r'`map="run=file"`'):
        read(write(named))
    recording = read(write(named), map=("run=file",))
    assert recording.run_names == ("a", "b") and recording.gaps == 0 and recording.segment[-1] == 1
    twice = pl.concat([frame.head(50), frame[47:100]])
    twice = twice.with_columns(
        time=pl.Series([*frame["time"][:50], *[frame["time"][49]] * 3, *frame["time"][50:100]])
    )
    with pytest.raises(RecordingError, match=r"row 51, column 'time': time is repeated"):
        read(write(twice))
    with pytest.raises(RecordingError, match=r"inside run 'r'"):
        read(write(twice.with_columns(run=pl.lit("r"))))


def test_interleaved_runs_are_gathered(write, frame):
    a = frame.with_columns(run=pl.lit(1.0))
    b = frame.with_columns(run=pl.lit(2.0))
    mixed = pl.concat([a[:1000], b, a[1000:]])
    recording = read(write(mixed))
    assert recording.run_names == ("1", "2")
    assert (np.diff(recording.run) >= 0).all()
    assert (np.diff(recording.time)[np.diff(recording.run) == 0] > 0).all()


def test_too_little(write, frame):
    with pytest.raises(RecordingError, match=r"1 sample is not a recording"):
        read(write(frame.head(1)))
    with pytest.raises(RecordingError, match=r"nothing moves, the velocity is zero throughout"):
        read(write(frame.drop("position").with_columns(velocity=pl.lit(0.0))))
    rng = np.random.default_rng(0)
    with pytest.raises(RecordingError, match=r"nothing moves, no sample is faster than"):
        noise = pl.Series(1e-3 * rng.standard_normal(2000))
        read(write(frame.drop("position").with_columns(velocity=noise)))
    with pytest.raises(RecordingError, match=r"the position .* moves and the velocity .* does not"):
        read(write(frame.with_columns(velocity=pl.lit(0.0))))


@pytest.mark.parametrize("sigma", [1e-4, 1e-3, 1e-2])
def test_noise_of_the_velocity(write, sigma):
    recording = read(write(joint(20_000, noise=sigma)))
    assert recording.velocity_noise == pytest.approx(sigma, rel=0.05)
    assert recording.velocity_threshold == 5 * recording.velocity_noise
    speed = np.abs(recording.velocity)
    # A sample beside one whose direction is unknown is not scored.
    unknown = np.pad(recording.velocity * recording.velocity_smooth < 0, 1)
    known = ~unknown[:-2] & ~unknown[2:]
    np.testing.assert_array_equal(recording.moving, (speed > recording.velocity_threshold) & known)
    scored = recording.scored()
    assert scored["rows"] == recording.moving.sum() and scored["share"] == scored["rows"] / 20_000


def test_noise_with_irregular_sampling_and_long_rests():
    rng = np.random.default_rng(3)
    t = np.cumsum(rng.uniform(0.003, 0.007, 8000))
    v = np.sin(2 * t) + 2e-3 * rng.standard_normal(8000)
    v[2000:7000] = 0.0  # clipped at rest: says nothing of the noise in motion
    assert noise_level(t, v, np.zeros(8000, dtype=int)) == pytest.approx(2e-3, rel=0.15)


def test_quantised_velocity_has_its_step_as_noise():
    t = np.arange(4000) / 200.0
    v = np.round(np.sin(t) / 0.024) * 0.024
    assert quantisation_step(v) == pytest.approx(0.024, rel=1e-6)
    assert quantisation_step(np.sin(t)) == 0.0
    assert noise_level(t, v, np.zeros(4000, dtype=int)) >= 0.024 / np.sqrt(12) * 0.999


def test_noise_free_recording(write):
    recording = read(write(joint(2000, noise=0.0)))
    assert recording.velocity_threshold < 1e-4
    assert recording.moving.mean() > 0.99


def test_blocks(write, frame):
    recording = read(write(frame))
    assert recording.block_count == 10
    np.testing.assert_array_equal(np.bincount(recording.block), 200)
    assert (np.diff(recording.block) >= 0).all()
    runs = pl.concat([frame.head(300 + 10 * k).with_columns(run=pl.lit(k)) for k in range(6)])
    recording = read(write(runs))
    assert recording.block_count == 6
    np.testing.assert_array_equal(recording.block, recording.run)
    few = read(write(runs.filter(pl.col("run") < 3)))
    assert few.block_count == 10 and set(few.block) == set(range(10))
    hole = read(write(frame), where="time < 1 or time > 8")
    assert set(hole.block) == set(range(10))


def steady_runs() -> pl.DataFrame:
    """Six runs at a steady speed each, three backward and three forward."""
    rng = np.random.default_rng(5)
    speeds = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0]
    return pl.concat(
        [
            pl.DataFrame(
                {
                    "time": np.arange(200) * 0.01,
                    "velocity": v + 0.05 * rng.standard_normal(200),
                    "torque": np.sign(v) + 0.3 * v + 0.1 * rng.standard_normal(200),
                    "file": [f"r{k}"] * 200,
                }
            )
            for k, v in enumerate(speeds)
        ]
    )


def test_average(write):
    speeds = [-3.0, -2.0, -1.0, 1.0, 2.0, 3.0]
    table = steady_runs()
    recording = read(write(table), map=("run=file",), average="run")
    assert recording.averaged and len(recording) == 6 and recording.block_count == 6
    np.testing.assert_allclose(recording.velocity, speeds, atol=0.02)
    np.testing.assert_array_equal(recording.time, np.arange(6))
    assert not recording.dt.any() and not recording.acceleration.any()
    assert recording.moving.all() and recording.velocity_noise < 0.05
    assert list(recording.segment) == list(range(6))
    with pytest.raises(RecordingError, match=r"needs a run column"):
        read(write(table), average="run")
    with pytest.raises(RecordingError, match=r'`average="file"`: unknown value; give run or row'):
        read(write(table), average="file")


def test_averaged_runs_are_held_out_by_a_column(write):
    way = pl.when(pl.col("file") < "r3").then(pl.lit("backward")).otherwise(pl.lit("forward"))
    table = steady_runs().with_columns(way=way, half=(pl.col("time") > 1.0).cast(int))
    said = {"map": ("run=file",), "average": "run"}
    recording = read(write(table), **said, hold_out="way")
    assert recording.block_count == 2 and recording.block.tolist() == [0, 0, 0, 1, 1, 1]
    one = read(write(table), **said, hold_out="way=forward")
    assert one.counted.tolist() == [False] * 3 + [True] * 3
    with pytest.raises(RecordingError, match="half changes within run r0, of which one point"):
        read(write(table), **said, hold_out="half")
    with pytest.raises(RecordingError, match="there is no column 'gain'"):
        read(write(table), **said, hold_out="gain")
    points = table.filter(pl.col("time") == 0.5).drop("time")
    rows = read(write(points), average="row", hold_out="way")
    assert rows.block.tolist() == recording.block.tolist()


def test_derived_velocity_and_acceleration(write):
    exact = joint(8000, rate=500.0, noise=0.0)
    rng = np.random.default_rng(2)
    table = exact.select("time", pl.col("position") + 2e-6 * rng.standard_normal(8000), "torque")
    recording = read(write(table))
    inner = slice(200, -200)
    v, a = exact["velocity"].to_numpy(), exact["acceleration"].to_numpy()
    assert np.abs(recording.velocity - v)[inner].max() < 2e-3 * np.abs(v).max()
    assert np.abs(recording.acceleration - a)[inner].max() < 1e-2 * np.abs(a).max()
    assert recording.velocity_noise == pytest.approx(np.sqrt(2) * 2e-6 * 500, rel=0.1)
    assert recording.columns["velocity"].derived and recording.cutoff_hz is not None
    assert any(
        n.startswith("velocity derived from position, zero-phase low-pass at")
        for n in recording.notes
    )


def test_filter_restarts_at_every_run(write):
    a, b = joint(1500, noise=1e-2, seed=1), joint(1500, noise=1e-2, seed=2)
    b = b.with_columns(pl.col("velocity") + 5.0)
    both = pl.concat([a.with_columns(run=pl.lit(0)), b.with_columns(run=pl.lit(1))])
    recording = read(write(both.drop("acceleration")))
    # The jump of 5 rad/s between the runs leaves no trace on either side.
    assert np.abs(recording.velocity_smooth - both["velocity"].to_numpy()).max() < 0.1
    assert np.abs(recording.acceleration).max() < 20.0


def test_irregular_sampling(write):
    rng = np.random.default_rng(7)
    t = np.cumsum(rng.uniform(0.0035, 0.0065, 6000))
    table = pl.DataFrame({"time": t, "position": np.sin(3 * t), "torque": np.cos(3 * t)})
    recording = read(write(table))
    np.testing.assert_allclose(recording.velocity[20:-20], 3 * np.cos(3 * t)[20:-20], atol=3e-2)


def test_short_segments(write, frame):
    pieces = frame.drop("velocity", "acceleration").with_columns(run=pl.int_range(pl.len()) // 5)
    recording = read(write(pieces))
    assert recording.velocity.shape == (2000,) and np.isfinite(recording.acceleration).all()
    assert np.abs(recording.velocity - frame["velocity"].to_numpy()).max() < 0.2


def test_smooth_is_closer_than_raw(write):
    exact = joint(6000, noise=0.0)
    recording = read(write(joint(6000, noise=0.02)))
    v = exact["velocity"].to_numpy()
    assert np.std(recording.velocity_smooth - v) < 0.4 * np.std(recording.velocity - v)
    denoised = recording.denoised("velocity")
    assert np.std(denoised - v) < 0.4 * np.std(recording.velocity - v)
    assert recording.denoised("velocity") is denoised
    assert recording.denoised("temperature") is recording.temperature


def test_scales(write, frame):
    scales = read(write(frame)).scales()
    assert scales["speed"] == pytest.approx(frame["velocity"].abs().max(), rel=0.02)
    assert scales["sample_period"] == pytest.approx(0.005)
    assert scales["temperature"] == pytest.approx(9.995)
    assert scales["position"] == pytest.approx(frame["position"].max() - frame["position"].min())


def test_sixty_thousand_rows_are_quick(write):
    path = write(joint(60_000))
    read(path)
    start = clock.perf_counter()
    read(path)
    assert clock.perf_counter() - start < 2.0


def test_a_table_of_points_needs_no_time_and_may_count_every_row(tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text("v,tau\n0.5,2.5\n-1,-3\n0,0.1\n2,4\n1,3\n")
    said = {"map": ["velocity=v", "friction_torque=tau"]}
    with pytest.raises(RecordingError, match=r'no time column.* `average="row"`'):
        read(path, **said)
    points = read(path, **said, average="row")
    assert points.velocity.tolist() == [0.5, -1.0, 0.0, 2.0, 1.0] and points.averaged
    assert points.moving.tolist() == [True, True, False, True, True]
    assert points.block_count == 5 and "each of 5 rows is a steady-state point" in points.notes[-2]
    every = read(path, **said, average="row", rows="all")
    assert every.moving.all()
    assert every.scored() == {"rows": 5, "share": 1.0, "velocity_threshold": 0.0}
    assert every.notes[-1] == "every sample is scored, moving or not, as given"
    with pytest.raises(RecordingError, match='`rows="most"`: unknown value; give moving or all'):
        read(path, **said, rows="most")
