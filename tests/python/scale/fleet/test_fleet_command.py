"""The command: JSON, refusals in one line, files that cannot be used, interrupts, lost workers."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb
from fleet_logs import answers, command

#: So many that a run lasts for seconds, and what befalls it comes before its end.
STARTS = 500


@pytest.mark.slow
def test_json_and_files_that_cannot_be_used(logs: list[Path], tmp_path: Path) -> None:
    robot = tmp_path / "r1"
    robot.mkdir()
    shutil.copy(logs[0], robot / "2026-03-01.parquet")
    (robot / "2026-03-02.parquet").write_bytes(b"no table")
    pl.read_parquet(logs[0]).with_columns(torque=float("nan")).write_parquet(
        robot / "2026-03-03.parquet"
    )
    done = command(
        str(tmp_path / "*" / "*.parquet"),
        tmp_path / "r1" / "gone.csv",
        "--model",
        "coulomb",
        "--workers",
        1,
        "-o",
        tmp_path / "fleet",
        "--json",
        "--plot",
        tmp_path / "fleet.png",
        "--report",
        tmp_path / "fleet.html",
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1 and "Traceback" not in done.stderr
    said = json.loads(done.stdout)
    assert (said["done"], said["failed"], said["model"]) == (2, 4, "coulomb")
    reasons = {Path(f["file"]).name: f["reason"] for f in said["failures"]}
    assert set(reasons) == {"2026-03-02.parquet", "2026-03-03.parquet", "gone.csv"}
    assert "No such file" in reasons["gone.csv"] and "torque" in reasons["2026-03-03.parquet"]
    assert answers(tmp_path / "fleet").height == 6
    assert (tmp_path / "fleet.png").read_bytes().startswith(b"\x89PNG")
    assert "<html" in (tmp_path / "fleet.html").read_text()


def test_the_days_of_a_column_and_the_joint_of_a_path(logs: list[Path], tmp_path: Path) -> None:
    for day, path in enumerate(logs[:2], start=1):
        log = pl.read_parquet(path).filter(joint="elbow").drop("joint")
        log = log.with_columns(date=pl.lit(f"2026-03-0{day}T06:00:00"))
        log.write_csv(tmp_path / f"arm-j{day}.csv")
    done = command(
        tmp_path / "*.csv",
        "--model",
        "coulomb",
        "--name",
        "{robot}-{joint}.csv",
        "--day",
        "date",
        "--workers",
        1,
        "-o",
        tmp_path / "fleet",
    )
    assert done.returncode == 0, done.stderr
    rows = answers(tmp_path / "fleet").select("robot", "joint", pl.col("day").cast(pl.String))
    assert rows.rows() == [("arm", "j1", "2026-03-01"), ("arm", "j2", "2026-03-02")]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--model", "columb"), "did you mean 'coulomb'"),
        (("--name", "{robo}.csv"), "did you mean 'robot'"),
        (("--sidecar", "gone.toml"), "gone.toml: no such sidecar"),
        (("--model", "gone.toml"), "cannot read the model file gone.toml"),
        (("--starts", "0"), "starts"),
        (("--map", "velocity=vel", "--model", "coulomb"), "nothing could be identified"),
        (("--scheduler", "nowhere"), "an address looks like tcp://10.0.0.7:8786"),
        (("--scheduler", "http://10.0.0.7:8786"), "unknown address scheme 'http'"),
        (("--scheduler", "tcp://127.0.0.1:1"), "no Dask scheduler answers at tcp://127.0.0.1:1"),
    ],
)
def test_wrong_arguments_are_one_line(
    logs: list[Path], tmp_path: Path, words: tuple[str, ...], sentence: str
) -> None:
    if "--scheduler" in words:
        pytest.importorskip("distributed")
    workers = () if "--scheduler" in words else ("--workers", 1)
    done = command(logs[0], *words, "-o", tmp_path / "fleet", *workers)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("stribeck: ") and done.stderr.count("\n") == 1
    assert sentence in done.stderr
    assert not (tmp_path / "fleet").exists()


def test_a_pattern_without_a_file_is_refused(tmp_path: Path) -> None:
    done = command(tmp_path / "*.parquet", "improve", "-o", tmp_path / "fleet")
    assert done.returncode == 2 and "no file matches" in done.stderr


def test_dask_is_not_imported_unless_it_is_asked_for() -> None:
    code = (
        "import sys, stribeck.cli.main, stribeck.scale.fleet.fleet\n"
        "assert not {'distributed', 'dask'} & set(sys.modules)\n"
        "sys.modules['distributed'] = None\n"
        "sys.argv = ['stribeck', 'fleet', 'a.csv', '--scheduler', 'tcp://127.0.0.1:1']\n"
        "stribeck.cli.main.main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "pip install stribeck[fleet]" in done.stderr


def start(logs: list[Path], folder: Path) -> subprocess.Popen[str]:
    """A run of two processes in a group of its own, once its first part is on disk."""
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "stribeck",
            "fleet",
            *map(str, logs),
            "--model",
            "bittencourt_a",
            "--starts",
            str(STARTS),
            "--workers",
            "2",
            "-o",
            str(folder),
            "--json",
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120.0
    while not any((folder / "results").glob("*.parquet")):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    return process


def workers_of(group: int) -> list[int]:
    """Processes that work in a group and have not ended."""
    listed = subprocess.run(
        ["ps", "-ww", "-eo", "pid=,pgid=,stat=,args="], capture_output=True, text=True, check=True
    )
    rows = [line.split(None, 3) for line in listed.stdout.splitlines()]
    return [
        int(pid)
        for pid, of, state, words in rows
        if of == str(group) and not state.startswith("Z") and "popen_loky" in words
    ]


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="process groups and signals are POSIX")
def test_a_process_that_is_killed_costs_only_its_task(logs: list[Path], tmp_path: Path) -> None:
    process = start(logs, tmp_path / "killed")
    os.kill(workers_of(process.pid)[0], signal.SIGKILL)
    out, error = process.communicate(timeout=300)
    assert process.returncode == 0, error
    assert "a worker was killed" in error and "Traceback" not in error
    said = json.loads(out)
    assert (said["done"], said["failed"]) == (48, 0)
    assert workers_of(process.pid) == []
    done = command(
        *logs,
        "--model",
        "bittencourt_a",
        "--starts",
        STARTS,
        "--workers",
        1,
        "-o",
        tmp_path / "alone",
    )
    assert done.returncode == 0, done.stderr
    assert answers(tmp_path / "killed").equals(answers(tmp_path / "alone"))


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="process groups and signals are POSIX")
def test_an_interrupt_keeps_what_is_done(logs: list[Path], tmp_path: Path) -> None:
    """Ctrl-C reaches every process of the group, as a terminal sends it."""
    process = start(logs, tmp_path / "fleet")
    os.killpg(process.pid, signal.SIGINT)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 130 and out == ""
    assert "stopped after" in error and "Traceback" not in error
    kept = answers(tmp_path / "fleet").height
    assert 0 < kept < 48
    again = sb.fleet(logs, tmp_path / "fleet", "bittencourt_a", starts=STARTS, workers=2)
    assert again.new == 48 - kept and again.rows.height == 48
