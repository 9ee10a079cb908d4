"""Recordings joined in memory are those of files read together; parts of a recording."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from synthetic import joint


@pytest.fixture
def files(tmp_path: Path) -> list[Path]:
    """Three files of one joint."""
    paths = [tmp_path / f"run_{k}.csv" for k in (1, 2, 3)]
    for k, path in enumerate(paths, 1):
        joint(rows=1000, seed=k).drop("acceleration").write_csv(path)
    return paths


def alike(one: sb.Recording, other: sb.Recording) -> None:
    """Every array and name is the same."""
    for field in fields(one):
        a, b = getattr(one, field.name), getattr(other, field.name)
        if isinstance(a, np.ndarray):
            assert np.array_equal(a, b), field.name
    assert one.run_names == other.run_names and one.sha256 == other.sha256
    assert one.notes == other.notes and one.checks == other.checks


def test_joined_recordings_are_files_read_together(files: list[Path]) -> None:
    alike(sb.concat([sb.read(path) for path in files]), sb.read(files))


def test_a_joined_recording_is_joined_again(files: list[Path]) -> None:
    one, two, three = (sb.read(path) for path in files)
    again = sb.concat([sb.concat([one, two]), three], names=["old", "new"])
    assert again.run_names == ("old/run_1", "old/run_2", "new")
    assert np.array_equal(again.velocity_smooth, sb.read(files).velocity_smooth)


def test_a_list_is_fitted_compared_and_diagnosed(files: list[Path]) -> None:
    each = [sb.read(path) for path in files]
    fitted = sb.fit("coulomb", each)
    whole = sb.fit("coulomb", sb.read(files))
    assert fitted.rmse == whole.rmse and fitted.recording.runs == 3
    assert sb.compare([fitted], each).models[0].fit is fitted
    assert sb.add(fitted, "offset", each).rmse <= fitted.rmse
    assert sb.evaluate(fitted.model, each[:2]).recording.runs == 2
    assert sb.diagnose(fitted, each, brief=True).fit is fitted
    improved = sb.improve("coulomb", each, most_steps=0)
    assert improved.final.rmse == fitted.rmse


def test_weights_go_with_their_recording(files: list[Path]) -> None:
    one, two = sb.read(files[0], weights="1 + position^2"), sb.read(files[1], weights="2")
    made = sb.concat([one, two])
    assert made.weight is not None and one.weight is not None
    np.testing.assert_array_equal(made.weight[:1000], one.weight)
    assert set(made.weight[1000:].tolist()) == {2.0}
    with pytest.raises(sb.RecordingError, match="weigh all samples or none"):
        sb.concat([one, sb.read(files[1])])


def test_a_part_of_a_recording(files: list[Path]) -> None:
    whole = sb.read(files)
    slow = whole.where("abs(velocity) < 0.5 and run != 'run_2'")
    assert slow.run_names == ("run_1", "run_3")
    assert np.abs(slow.velocity).max() < 0.5
    assert slow.gaps > 0 and slow.notes[-3:] != whole.notes[-3:]
    assert any("removed by where: abs(velocity)" in note for note in slow.notes)
    late = sb.read(files[0]).where("time >= 5")
    alike_file = sb.read(files[0], where="time >= 5")
    assert np.array_equal(late.acceleration, alike_file.acceleration)


@pytest.mark.parametrize(
    ("condition", "said"),
    [
        ("time > 1e9", "keeps none of 3000 rows"),
        ("velocty > 0", "did you mean 'velocity'"),
        ("velocity >", "position"),
        (3, "a condition"),
    ],
)
def test_wrong_conditions(files: list[Path], condition: Any, said: str) -> None:
    with pytest.raises(sb.StribeckError, match=said):
        sb.read(files).where(condition)


def test_wrong_lists(files: list[Path]) -> None:
    one = sb.read(files[0])
    for given, said in (
        ([], "at least one"),
        ([one, "run.csv"], "'run.csv' is not a recording: read it first"),
        ("run.csv", "'run.csv' is not a recording: read it first"),
        (3, "a int is not a recording"),
    ):
        with pytest.raises(sb.RecordingError, match=said):
            sb.fit("coulomb", given)
    with pytest.raises(sb.StribeckError, match="a list of recordings"):
        sb.concat(one)
    with pytest.raises(sb.RecordingError, match="a name of its own"):
        sb.concat([one, one], names=["a", "a"])
    assert sb.concat([one, one]).run_names == ("1", "2")
    points = sb.read(files, average="run", rows="all")
    with pytest.raises(sb.RecordingError, match="read the files together"):
        sb.concat([points, points])


@pytest.mark.parametrize(
    ("condition", "alike"),
    [("torque > 1", "current > 0.05"), ("abs(current) < 0.125", "abs(torque) < 2.5")],
)
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_a_condition_on_a_torque_from_a_current(
    tmp_path: Path, kind: str, condition: str, alike: str
) -> None:
    """Torque and current are seen when a file is read, and in the recording."""
    t = np.arange(3000) / 100.0
    options: dict[str, Any] = {"torque_constant": 0.5, "gear_ratio": 40.0, "joint_kind": kind}
    if kind == "prismatic":
        options |= {"screw_pitch": 0.01}
        effort = 2.0 * np.pi / 0.01
        condition, alike = (c.replace("torque", f"torque/{effort}") for c in (condition, alike))
    torque = 2.0 * np.sign(np.sin(t)) + np.sin(t)
    path = tmp_path / "current.csv"
    frame = {"time": t, "velocity_radps": np.sin(t), "current": torque / 20.0}
    pl.DataFrame(frame).write_csv(path)
    whole = sb.read(path, **options)
    counts = {sb.read(path, where=c, **options).rows for c in (condition, alike)}
    counts |= {whole.where(c).rows for c in (condition, alike)}
    assert len(counts) == 1 and 0 < counts.pop() < whole.rows


def test_a_torque_that_was_measured_has_no_current(files: list[Path]) -> None:
    with pytest.raises(sb.RecordingError, match="the recording has no channel 'current'; it has"):
        sb.read(files[0]).where("current > 1")
    with pytest.raises(sb.RecordingError, match="'mean' sees all samples of a file"):
        sb.read(files[0]).where("velocity > mean(velocity)")
