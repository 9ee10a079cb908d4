"""The methods through the command line: files and one JSON object out, one line where it is bad."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gantry
import passes
import planar_arm
import polars as pl
import pytest
import stribeck as sb
from stribeck.cli.main import main


@dataclass(frozen=True)
class Done:
    """What a command left behind."""

    returncode: int
    stdout: str
    stderr: str


def stribeck(*words: object) -> Done:
    """Run the command as a user does, in this process: starting one takes longer than the work."""
    stdout, stderr, code = io.StringIO(), io.StringIO(), 0
    with (
        pytest.MonkeyPatch.context() as patched,
        contextlib.redirect_stdout(stdout),
        contextlib.redirect_stderr(stderr),
    ):
        patched.setattr(sys, "argv", ["stribeck", *map(str, words)])
        try:
            main()
        except SystemExit as stop:
            code = int(stop.code or 0)
    return Done(code, stdout.getvalue(), stderr.getvalue())


def answer(*words: object) -> dict[str, Any]:
    """The one JSON object that a command prints."""
    done = stribeck(*words, "--json")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    return json.loads(done.stdout)


def refused(*words: object) -> str:
    """The one line with which a command ends; nothing on stdout."""
    done = stribeck(*words)
    lines = [x for x in done.stderr.splitlines() if not x.startswith("note: ")]
    assert done.returncode == 2 and done.stdout == "", done
    assert len(lines) == 1 and lines[0].startswith("stribeck: "), done.stderr
    return lines[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("commands")
    passes.log([0.05, 0.1, 0.2, 0.4, 0.8, 1.2]).write_csv(path / "passes.csv")
    gantry.displacement_log([0.02, 0.05, 0.1]).write_parquet(path / "gantry.parquet")
    planar_arm.recording_frame(repetitions=2).write_parquet(path / "arm.parquet")
    return path


def test_points_by_averaging_and_a_grid_upon_them(folder: Path) -> None:
    points = folder / "points.csv"
    made = answer(
        "points", folder / "passes.csv", "--method", "averaging", "--bins", 4, "-o", points
    )
    assert made["method"] == "averaging" and len(made["points"]) == 24
    assert {"velocity", "friction_torque", "friction_stderr", "load_torque", "temperature"} <= set(
        made["points"][0]
    )
    fitted = answer(
        "fit",
        points,
        "--model",
        "coulomb+stribeck",
        "--method",
        "grid",
        "--grid",
        "stribeck_velocity=0.02:0.5:15",
    )
    value = fitted["parameters"]["coulomb_friction"]["value"]
    assert value == pytest.approx(passes.COULOMB, rel=0.05)
    assert any("least absolute error" in note for note in fitted["notes"])


def test_rms_is_the_default_method(folder: Path) -> None:
    points = folder / "rms.csv"
    answer("points", folder / "passes.csv", "--method", "averaging", "-o", points)
    by_name = answer("fit", points, "--model", "coulomb", "--method", "rms")
    by_default = answer("fit", points, "--model", "coulomb")
    assert by_name["parameters"] == by_default["parameters"]


def test_points_by_segments(folder: Path) -> None:
    points = folder / "map.csv"
    made = answer(
        "points",
        folder / "gantry.parquet",
        "--joint-kind",
        "prismatic",
        "--method",
        "segments",
        "-o",
        points,
    )
    assert len(made["points"]) == 6 and made["torque_unit"] == "N"
    recording = sb.read(points)
    assert recording.averaged and recording.joint_kind == "prismatic" and recording.rows == 6


def test_arm(folder: Path, tmp_path: Path) -> None:
    made = answer(
        "arm", folder / "arm.parquet", "--first-link-length", 0.35, "-o", tmp_path / "friction"
    )
    assert len(made["parameters"]) == 12 and len(made["relative_errors"]) == 2
    assert made["parameters"]["inertia_1"]["value"] == pytest.approx(3.689, rel=0.02)
    for joint in (1, 2):
        model = sb.load(tmp_path / f"friction_joint_{joint}.toml")
        expected = made["parameters"][f"coulomb_{joint}"]["value"]
        assert model.law == "hao_a" and model.values[0] == expected


def test_an_arm_on_another_recording(folder: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.parquet"
    planar_arm.recording_frame(seed=7, repetitions=1).write_parquet(other)
    words = ("arm", folder / "arm.parquet", "--first-link-length", 0.35, "--evaluate")
    made = answer(*words, other)
    (row,) = made["evaluated"]
    assert row["file"] == str(other) and all(error > 0.0 for error in row["rmse"])
    # The same motion with other noise: the same errors.
    assert row["relative_residual"] == pytest.approx(made["relative_errors"], rel=0.05)
    assert "other.parquet, not fitted: torque error" in stribeck(*words, other).stdout
    assert "the arm is fitted to it" in refused(*words, folder / "arm.parquet")


def test_tables_are_readable(folder: Path) -> None:
    for words in (
        ("points", folder / "passes.csv", "--method", "averaging"),
        ("arm", folder / "arm.parquet", "--first-link-length", 0.35),
    ):
        done = stribeck(*words)
        assert done.returncode == 0, done.stderr
        assert "nan" not in done.stdout and max(map(len, done.stdout.splitlines())) <= 98


def test_bad_input_is_one_line(folder: Path, tmp_path: Path) -> None:
    data = folder / "passes.csv"
    without = tmp_path / "without.csv"
    pl.read_csv(data).drop("position").with_columns(velocity=pl.lit(1.0)).write_csv(without)
    assert "no position column" in refused("points", without, "--method", "segments")
    assert "forward and" in refused("points", data, "--method", "averaging", "--where", "time < 16")
    assert "no interval of constant speed" in refused(
        "points", data, "--method", "segments", "--shortest", 500
    )
    assert "--grid" in refused(
        "fit", data, "--model", "coulomb", "--grid", "coulomb_friction=1:2:3"
    )
    assert "NAME=FROM:TO:COUNT" in refused(
        "fit", data, "--model", "coulomb", "--method", "grid", "--grid", "a=1"
    )
    assert "--first-link-length" in refused("arm", folder / "arm.parquet")
    assert "no joint '3'" in refused(
        "arm", folder / "arm.parquet", "--first-link-length", 0.35, "--joints", 1, 3
    )
    assert "the folder" in refused(
        "points", data, "--method", "segments", "-o", tmp_path / "no" / "points.csv"
    )
