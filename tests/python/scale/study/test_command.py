"""The command: one JSON object, refusals in one line, Ctrl-C in the middle and going on."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from stribeck.scale.study.store import FITS

from .conftest import command


@pytest.mark.slow
def test_json_alone_on_stdout(two_joints: Path, tmp_path: Path) -> None:
    done = command(
        two_joints,
        "--law",
        "coulomb",
        "--law",
        "bittencourt_a",
        "--starts",
        2,
        "--json",
        "-o",
        tmp_path / "out",
        "--workers",
        1,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    assert json.loads(done.stdout)["output"] == str(tmp_path / "out")
    assert "Traceback" not in done.stderr
    answer = json.loads(done.stdout)
    assert all(f"note: {text}\n" in done.stderr for text in answer["data"]["notes"])


@pytest.mark.slow
def test_the_folder_is_named_after_the_data(two_joints: Path, tmp_path: Path) -> None:
    done = command(two_joints, "--law", "coulomb", "--workers", 1, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "two.study" / "tables.txt").read_text() == done.stdout


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--law", "columb"), "did you mean 'coulomb'"),
        (("--law", "coulomb", "--joint", "nea"), "did you mean 'near'"),
        (("--law", "coulomb", "--low-speed", -1), "must be above zero"),
        (("--law", "coulomb", "--starts", 0), "starts"),
    ],
)
def test_wrong_arguments_are_one_line(
    two_joints: Path, tmp_path: Path, words: tuple, sentence: str
) -> None:
    done = command(two_joints, *words, "-o", tmp_path / "out")
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("stribeck: ") and done.stderr.count("\n") == 1
    assert sentence in done.stderr
    assert not (tmp_path / "out").exists()


def fits_in(folder: Path) -> int:
    path = folder / FITS
    return path.read_text().count("\n") - 1 if path.exists() else 0


def running_in_group(group: int) -> dict[int, str]:
    """Processes of a group that have not ended, by their numbers."""
    listed = subprocess.run(
        ["ps", "-ww", "-eo", "pid=,pgid=,stat=,args="], capture_output=True, text=True
    )
    rows = [line.split(None, 3) for line in listed.stdout.splitlines()]
    return {
        int(pid): words
        for pid, of, state, words in rows
        if of == str(group) and not state.startswith("Z")
    }


LONG = ("--law", "lugre", "--law", "bittencourt_a")


def start_long_study(data: Path, folder: Path, workers: int) -> subprocess.Popen[str]:
    """A study in a process group of its own, once it has made some of its 800 fits."""
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "stribeck",
            "study",
            str(data),
            *LONG,
            "--starts",
            "200",
            "-o",
            str(folder),
            "--workers",
            str(workers),
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120.0
    while fits_in(folder) < 3:
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.02)
    return process


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="process groups and SIGINT are POSIX")
@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_keeps_what_is_done(two_joints: Path, tmp_path: Path, workers: int) -> None:
    """Ctrl-C reaches every process of the group, as a terminal sends it."""
    folder = tmp_path / "out"
    process = start_long_study(two_joints, folder, workers)
    os.killpg(process.pid, signal.SIGINT)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert "Traceback" not in error and "stopped after" in error
    kept = fits_in(folder)
    assert 3 <= kept < 800
    assert (folder / "fits.parquet").exists()
    deadline = time.monotonic() + 30.0
    while running_in_group(process.pid):
        assert time.monotonic() < deadline
        time.sleep(0.05)

    other = command(two_joints, *LONG, "--starts", 3, "-o", folder)
    assert other.returncode == 2 and "another number of starts (200 there, 3 here)" in other.stderr
    assert fits_in(folder) == kept


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="process groups and signals are POSIX")
def test_a_process_that_is_killed_ends_the_study_in_one_line(
    two_joints: Path, tmp_path: Path
) -> None:
    """As the system does for want of memory."""
    process = start_long_study(two_joints, tmp_path / "out", 2)
    fitting = [p for p, words in running_in_group(process.pid).items() if "popen_loky" in words]
    os.kill(fitting[0], signal.SIGKILL)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 2 and out == ""
    last = error.splitlines()[-1]
    assert last.startswith("stribeck: a worker process of the study was killed")
    assert "Traceback" not in error
    assert 3 <= fits_in(tmp_path / "out") < 800
