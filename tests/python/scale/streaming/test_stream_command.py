"""`stribeck fit` of a folder, and of one file with --stream."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.cli.main import cli
from stribeck.cli.progress import RowProgress
from synthetic import joint


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    frame = joint(rows=6000)
    made = tmp_path / "logs"
    made.mkdir()
    frame[:3000].write_parquet(made / "a.parquet")
    frame[3000:].write_parquet(made / "b.parquet")
    return made


def test_a_folder_is_fitted_as_one_recording(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "model.toml"
    done = CliRunner().invoke(
        cli, ["fit", str(folder), "--model", "coulomb", "--stream", "--json", "-o", str(target)]
    )
    assert done.exit_code == 0, done.output
    answer = json.loads(done.stdout)
    assert answer["data"]["files"] == 2 and answer["data"]["rows"] == 6000
    assert answer["data"]["passes"] == 1
    assert sb.load(str(target)).value("coulomb_friction") == pytest.approx(3.0, abs=0.05)


def test_without_the_flag_the_files_of_a_folder_are_runs(folder: Path) -> None:
    done = CliRunner().invoke(cli, ["inspect", str(folder), "--json"])
    answer = json.loads(done.stdout)
    assert answer["runs"] == 2 and [row["rows"] for row in answer["files"]] == [3000, 3000]


def test_several_paths_are_not_streamed(folder: Path) -> None:
    both = [str(folder / "a.parquet"), str(folder / "b.parquet")]
    done = CliRunner().invoke(cli, ["fit", *both, "--model", "coulomb", "--stream"])
    assert isinstance(done.exception, sb.SpecError)
    assert "--stream reads one file, folder or pattern, 2 are given" in str(done.exception)


def test_one_file_needs_the_flag(folder: Path) -> None:
    path = str(folder / "a.parquet")
    plain = CliRunner().invoke(cli, ["fit", path, "--model", "coulomb", "--json"])
    streamed = CliRunner().invoke(cli, ["fit", path, "--model", "coulomb", "--json", "--stream"])
    assert "data" not in json.loads(plain.stdout)
    assert json.loads(streamed.stdout)["data"]["rows"] == 3000


def test_what_needs_memory_is_refused(folder: Path) -> None:
    words = ["fit", str(folder), "--model", "coulomb"]
    done = CliRunner().invoke(cli, [*words, "--stream", "--passive"])
    assert isinstance(done.exception, sb.SpecError)
    assert "--passive needs all samples in memory" in str(done.exception)


def test_progress_tells_the_rate_and_the_time_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]
    monkeypatch.setattr("stribeck.cli.progress.time.monotonic", lambda: now[0])
    with RowProgress() as bar:
        bar.show_pass(0, 900, 1)
        now[0] = 30.0
        bar.show_pass(300, 900, 1)
        now[0] = 60.0
        bar.show_pass(600, 900, 1)
    assert capsys.readouterr().err.splitlines() == [
        "note: pass 1: 300 of 900 samples, 10 per second, about 60 s left",
        "note: pass 1: 600 of 900 samples, 10 per second, about 30 s left",
    ]
