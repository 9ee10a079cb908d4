"""Runs that hold the same samples are refused: what is held out must not be fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import RecordingError
from synthetic import joint


def written(folder: Path, frames: list[pl.DataFrame]) -> list[str]:
    """Each frame as a file."""
    paths = [folder / f"run{k}.parquet" for k in range(len(frames))]
    for frame, path in zip(frames, paths, strict=True):
        frame.write_parquet(path)
    return [str(path) for path in paths]


def test_a_file_inside_another_is_refused(tmp_path: Path) -> None:
    frame = joint()
    later = frame[500:1500].with_columns(time=pl.col("time") - frame["time"][500])
    files = written(tmp_path, [frame, later])
    with pytest.raises(RecordingError, match=r"100 % .* run 'run1' are those of run 'run0'"):
        sb.fit("coulomb", sb.read(files))
    # Without the run that repeats the other, nothing contradicts.
    apart = sb.read(files).where("run != 'run1'")
    assert all(check.check != "run" for check in apart.checks)
    assert sb.fit("coulomb", apart).rmse_held_out is not None
    trusted = sb.read(files, trust=True)
    assert sb.fit("coulomb", trusted).rmse_held_out is not None


def test_runs_with_friction_measured_directly(tmp_path: Path) -> None:
    """The load torque of zero beside it has no column."""
    frame = joint(rows=1000).rename({"torque": "friction_torque"}).drop("load_torque", strict=False)
    halves = [frame.with_columns(run=pl.lit(name)) for name in ("a", "b")]
    other = halves[1].with_columns(pl.col("friction_torque") + np.linspace(0.0, 0.01, 1000))
    (path,) = written(tmp_path, [pl.concat([halves[0], other])])
    recording = sb.read(path)
    assert recording.run_names == ("a", "b") and all(check.ok for check in recording.checks)
    (path,) = written(tmp_path, [pl.concat(halves)])
    with pytest.raises(RecordingError, match=r"100 % .* run 'b' are those of run 'a'"):
        sb.fit("coulomb", sb.read(path))


def test_runs_of_one_file_are_compared_too(tmp_path: Path) -> None:
    frame = joint(rows=1000)
    both = pl.concat([frame.with_columns(run=pl.lit(name)) for name in ("a", "b")])
    (path,) = written(tmp_path, [both])
    with pytest.raises(RecordingError, match="leave out one of the two files, or rows with"):
        sb.fit("coulomb", sb.read(path))


def test_one_motion_that_was_measured_twice_is_accepted(tmp_path: Path) -> None:
    frame = joint(rows=1500)
    noise = 0.01 * np.random.default_rng(9).standard_normal(frame.height)
    files = written(tmp_path, [frame, frame.with_columns(torque=frame["torque"] + noise)])
    recording = sb.read(files)
    assert all(check.check != "run" for check in recording.checks)
    assert sb.fit("coulomb", recording).rmse_held_out is not None


def test_the_same_rest_in_two_runs_is_no_repetition(tmp_path: Path) -> None:
    frame = joint(rows=1500)
    rest = pl.concat([frame[:1]] * 300).with_columns(
        time=pl.arange(300, eager=True) * 0.01, velocity=pl.lit(0.0)
    )
    shifted = frame.with_columns(time=pl.col("time") + 3.0)
    other = shifted.with_columns(torque=pl.col("torque") * 1.001)
    files = written(tmp_path, [pl.concat([rest, run]) for run in (shifted, other)])
    assert all(check.check != "run" for check in sb.read(files).checks)


def test_a_simulation_without_noise_may_repeat_itself() -> None:
    t = np.arange(0.0, 20.0, 0.01)
    v = np.sin(1.1 * t) + 0.4 * np.sin(3.7 * t)
    columns = {"time": t, "velocity": v, "torque": 2.0 * np.sign(v) + v}
    both = {name: np.tile(values, 2) for name, values in columns.items()}
    run = np.repeat([1, 2], t.size)
    noise = 1e-3 * np.tile(np.random.default_rng(1).standard_normal(t.size), 2)
    for torque, is_refused in ((both["torque"], False), (both["torque"] + noise, True)):
        made = sb.Recording.from_columns(run=run, **{**both, "torque": torque})
        assert any(check.check == "run" for check in made.checks) == is_refused


def turning(begin: float, stroke: float = 40.0) -> pl.DataFrame:
    """A joint that turns on, from a position on."""
    t = np.arange(0.0, 10.0, 0.01)
    q = begin + stroke * (1.0 - np.cos(0.8 * t)) / 2.0
    v = np.gradient(q, t)
    noise = 0.01 * np.random.default_rng(round(begin)).standard_normal(t.size)
    return pl.DataFrame({"time": t, "position": q, "velocity": v, "torque": np.sign(v) + noise})


@pytest.mark.parametrize(
    ("begins", "stroke", "is_told"),
    [((0.0, 0.0), 40.0, True), ((0.0, 3.0), 40.0, False), ((0.0, 0.0), 2.0, False)],
)
def test_a_position_that_begins_anew_in_each_run(
    tmp_path: Path, begins: tuple[float, float], stroke: float, is_told: bool
) -> None:
    frames = [turning(begin, stroke) for begin in begins]
    noise = 0.01 * np.random.default_rng(7).standard_normal(frames[1].height)
    frames[1] = frames[1].with_columns(torque=frames[1]["torque"] + noise)
    checks = sb.read(written(tmp_path, frames)).checks
    assert [check.is_open for check in checks if check.check == "zero"] == [True] * is_told
