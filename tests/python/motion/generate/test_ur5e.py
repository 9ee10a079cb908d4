"""The arm's recordings: seeded, shaped as the review's tests, read back as they were made."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from polars.testing import assert_frame_equal
from stribeck.base.errors import SpecError
from stribeck.motion.generate.files import write_robot
from stribeck.motion.generate.ur5e import JOINTS, LIMITS, RobotRecording

COLUMNS = [
    "joint",
    "run",
    "time",
    "position",
    "velocity",
    "current",
    "load_torque",
    "temperature",
]


def test_the_same_seed_makes_the_same_recording_and_another_another() -> None:
    first, again, other = (
        RobotRecording(test=2, seed=seed, repeats=1, rate=50.0).joint_frame("elbow")
        for seed in (4, 4, 5)
    )
    assert_frame_equal(first, again, check_exact=True)
    assert not first["current"].equals(other["current"])


def test_test_1_is_short_and_fast() -> None:
    made = RobotRecording(test=1, repeats=1)
    frame = made.joint_frame("base")
    assert frame.columns == COLUMNS
    assert 8.0 < made.trajectory.seconds < 30.0
    fastest = [made.joint_frame(j)["velocity"].abs().max() for j in JOINTS]
    assert max(fastest) == pytest.approx(LIMITS.speed, rel=0.01)
    assert np.median(np.diff(frame["time"])) == pytest.approx(0.002)


def test_test_2_repeats_and_warms_up() -> None:
    """Cycles that are not recorded warm the joint up too."""
    made = RobotRecording(test=2, repeats=21, every=10, rate=100.0)
    frame = made.joint_frame("shoulder")
    assert frame["run"].unique(maintain_order=True).to_list() == [1, 11, 21]
    runs = frame.partition_by("run")
    assert all(run.height == 6000 for run in runs)
    assert_frame_equal(runs[0].select("position"), runs[2].select("position"), check_exact=True)
    assert runs[2]["time"][0] == pytest.approx(1200.0)
    cold, hot = runs[0]["temperature"].mean(), runs[2]["temperature"].mean()
    assert hot > cold + 5.0
    effort = [float((r["current"] * 100.0 * 0.12 - r["load_torque"]).abs().mean()) for r in runs]
    assert effort[2] < 0.97 * effort[0]


def test_the_sidecar_says_what_each_joint_is(tmp_path: Path) -> None:
    path = tmp_path / "arm.parquet"
    made = RobotRecording(test=1, repeats=1)
    write_robot(made, path)
    path.with_name("arm.parquet.sidecar.toml").write_text(made.sidecar_text())
    assert [p.name for p in tmp_path.glob(".*")] == []
    large, small = sb.read(path, joint="base"), sb.read(path, joint="wrist_3")
    assert (large.motor["km"], small.motor["km"]) == (0.11, 0.05)
    frame = made.joint_frame("wrist_3")
    expected = frame["current"].to_numpy() * 0.1 * 100.0
    np.testing.assert_allclose(small.torque, expected, rtol=1e-12)
    assert made.rows == 6 * small.rows
    assert 5.0 * small.velocity_noise < 0.02


def test_csv_reads_as_parquet_does(tmp_path: Path) -> None:
    made = RobotRecording(test=1, repeats=1, rate=50.0)
    for name in ("a.csv", "a.parquet"):
        write_robot(made, tmp_path / name)
    assert_frame_equal(
        pl.read_csv(tmp_path / "a.csv"),
        pl.read_parquet(tmp_path / "a.parquet"),
        check_dtypes=False,
        rel_tol=1e-12,
    )


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"test": 3}, "trapezoidal"),
        ({"repeats": 0}, "1 to 10000"),
        ({"repeats": 2, "every": 3}, "1 to 2"),
        ({"rate": 123.0}, "whole number"),
        ({"rate": float("nan")}, "whole number"),
        ({"seed": -1}, "0 or more"),
    ],
)
def test_what_makes_no_recording_is_refused(wrong: dict, word: str) -> None:
    with pytest.raises(SpecError, match=word):
        RobotRecording(**wrong)


def command(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "stribeck", "generate", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


def test_the_command_writes_recording_sidecar_and_truth(tmp_path: Path) -> None:
    path = tmp_path / "arm.parquet"
    done = command("--robot", "ur5e", "--test", 1, "--rate", 50, "-o", path, "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["rows"] == pl.read_parquet(path).height
    assert json.loads(Path(answer["truth_path"]).read_text())["joints"].keys() == set(JOINTS)
    assert sb.read(path, joint="elbow").motor["gear_ratio"] == 100.0


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--robot", "ur5e", "--law", "lugre"), "--law has no effect with --robot ur5e"),
        (("--every", 2), "--every has no effect for a single joint"),
    ],
)
def test_options_of_the_other_kind_are_refused(tmp_path: Path, words: tuple, sentence: str) -> None:
    done = command(*words, "-o", tmp_path / "x.parquet")
    assert done.returncode == 2 and sentence in done.stderr and not done.stdout
    assert list(tmp_path.iterdir()) == []
