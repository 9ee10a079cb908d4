"""Bad input through the real command: exit code 2, one line, empty stdout, no output file."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest


def stribeck(*words: object) -> subprocess.CompletedProcess[str]:
    """Run the command as a user does."""
    return subprocess.run(
        [sys.executable, "-m", "stribeck", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


@pytest.fixture
def frame() -> pl.DataFrame:
    """A good recording of a revolute joint, 20 s at 100 Hz."""
    rng = np.random.default_rng(1)
    time = np.arange(2000) / 100.0
    velocity = np.sin(time)
    torque = 2.0 * np.sign(velocity) + 0.5 * velocity + 0.05 * rng.standard_normal(time.size)
    return pl.DataFrame(
        {
            "time": time,
            "position": 1.0 - np.cos(time),
            "velocity": velocity + 1e-4 * rng.standard_normal(time.size),
            "torque": torque,
            "load_torque": np.zeros_like(time),
        }
    )


def refused(result: subprocess.CompletedProcess[str], *said: str) -> None:
    """Exit code 2, nothing on stdout, and one last line that says what is wrong."""
    lines = [x for x in result.stderr.splitlines() if not x.startswith("note: ")]
    assert result.returncode == 2, result.stderr
    assert result.stdout == ""
    assert len(lines) == 1, result.stderr
    assert lines[0].startswith("stribeck: ")
    assert "Traceback" not in result.stderr
    for words in said:
        assert words in lines[0], lines[0]


def fit(path: Path, *words: object) -> subprocess.CompletedProcess[str]:
    """Fit with an output file, and check that a refusal leaves none behind."""
    output = path.parent / "model.toml"
    result = stribeck("fit", path, "--model", "coulomb", "-o", output, "--json", *words)
    if result.returncode != 0:
        assert not output.exists()
        assert not list(path.parent.glob(".model.toml*"))
    return result


def test_good_recording_is_accepted(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    result = fit(path)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "model.toml").exists()


@pytest.mark.parametrize("name", ["empty.csv", "empty.parquet"])
def test_empty_file(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(b"")
    refused(fit(path), name, "empty")


def test_missing_column(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "short.csv"
    frame.drop("torque").write_csv(path)
    refused(fit(path), "torque", "--map")


def test_text_in_a_number_column(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "text.csv"
    text = frame.write_csv().splitlines()
    text[7] = text[7].rsplit(",", 2)[0] + ",abc,0.0"
    path.write_text("\n".join(text))
    refused(fit(path), "torque", "abc")


def test_few_missing_rows_are_dropped_and_counted(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "few.csv"
    torque = frame["torque"].to_numpy().copy()
    torque[10:40] = np.nan
    torque[50] = np.inf
    frame.with_columns(torque=pl.Series(torque)).write_csv(path)
    result = fit(path)
    assert result.returncode == 0, result.stderr
    assert "31 of 2000 rows" in result.stderr


def test_many_missing_rows_are_refused(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "many.csv"
    torque = frame["torque"].to_numpy().copy()
    torque[10:400] = np.nan
    frame.with_columns(torque=pl.Series(torque)).write_csv(path)
    refused(fit(path), "many.csv", "390")


def test_time_running_backwards(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "back.csv"
    time = frame["time"].to_numpy().copy()
    time[100] = time[90]
    frame.with_columns(time=pl.Series(time)).write_csv(path)
    refused(fit(path), "back.csv", "time")


def test_nothing_moves(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "still.csv"
    frame.with_columns(velocity=pl.lit(0.0), position=pl.lit(0.3)).write_csv(path)
    refused(fit(path), "move")


def test_one_sample(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "one.csv"
    frame.head(1).write_csv(path)
    refused(fit(path), "one.csv")


def test_truncated_parquet(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "cut.parquet"
    frame.write_parquet(path)
    path.write_bytes(path.read_bytes()[:500])
    refused(fit(path), "cut.parquet")


def test_unreadable_paths(tmp_path: Path) -> None:
    refused(fit(tmp_path / "absent.csv"), "absent.csv")
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    refused(fit(folder), "folder.csv")


def test_unit_nonsense(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    refused(fit(path, "--unit", "velocity=furlong"), "furlong")
    refused(fit(path, "--unit", "velocity=kg"), "kg")


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("coulombe", "did you mean 'coulomb'"),
        ("coulomb+lod", "did you mean 'load'"),
        ("coulomb+load+load", "twice"),
        ("lugre+presliding", "presliding"),
        ("coulomb+temperature_dry", "temperature"),
        ("", "unknown"),
    ],
)
def test_unusable_spec(tmp_path: Path, frame: pl.DataFrame, spec: str, said: str) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    refused(stribeck("fit", path, "--model", spec, "--json"), said)


@pytest.mark.slow
def test_unknown_effect_and_command(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    refused(stribeck("add", "coulomb", "gravty", path, "--json"), "did you mean 'gravity'")
    refused(stribeck("improv", path), "did you mean 'improve'")
    refused(stribeck("fit", path), "--model")


@pytest.mark.slow
def test_model_files(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    model = tmp_path / "m.toml"
    assert stribeck("fit", path, "--model", "coulomb", "-o", model).returncode == 0
    good = model.read_text()
    for old, new, said in [
        ('kind = "model"', 'kind = "recording"', "line 1"),
        ("coulomb_friction", "coulomb_frictoin", "did you mean 'coulomb_friction'"),
        ("value = ", "value = nan #", "finite"),
        ("[fitted_on]", "colour = 1\n[fitted_on]", "colour"),
        ('torque_unit = "N m"', 'torque_unit = "lbf"', "lbf"),
    ]:
        assert old in good
        model.write_text(good.replace(old, new, 1))
        refused(stribeck("compare", path, model, "--json"), "m.toml", said)
    model.write_text("not toml [")
    refused(stribeck("compare", path, model, "--json"), "m.toml")
    refused(stribeck("compare", path, tmp_path / "absent.toml", "--json"), "absent.toml")


def test_output_that_cannot_be_written(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "good.csv"
    frame.write_csv(path)
    refused(
        stribeck("fit", path, "--model", "coulomb", "-o", tmp_path / "nowhere" / "m.toml"),
        "nowhere",
    )


@pytest.mark.slow
def test_several_joints_are_never_picked_silently(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "two.csv"
    both = pl.concat([frame.with_columns(joint=pl.lit(j)) for j in ("hip", "knee")])
    both.write_csv(path)
    refused(fit(path), "hip", "knee", "--joint")
    assert fit(path, "--joint", "knee").returncode == 0
    assert stribeck("inspect", path, "--json").returncode == 0


def test_a_description_of_a_robot_has_its_ending(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "run.csv"
    frame.write_csv(path)
    refused(stribeck("robot", "fit", path, "--urdf", path), "--urdf", "ends in .urdf or .xml")
