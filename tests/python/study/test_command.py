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
from stribeck.study.store import FITS

from .conftest import command


def test_json_alone_on_stdout(two_joints: Path, tmp_path: Path) -> None:
    done = command(
        two_joints, "--law", "coulomb", "--law", "bittencourt_a", "--starts", 2, "--json",
        "-o", tmp_path / "out", "--workers", 1,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    assert json.loads(done.stdout)["output"] == str(tmp_path / "out")
    assert "Traceback" not in done.stderr
    answer = json.loads(done.stdout)
    assert all(f"note: {text}\n" in done.stderr for text in answer["data"]["notes"])


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


def running_in_group(group: int) -> list[str]:
    """Processes of a group that have not ended."""
    listed = subprocess.run(["ps", "-eo", "pgid=,stat=,args="], capture_output=True, text=True)
    rows = [line.split(None, 2) for line in listed.stdout.splitlines()]
    return [row[2] for row in rows if row[0] == str(group) and not row[1].startswith("Z")]


@pytest.mark.skipif(os.name == "nt", reason="process groups and SIGINT are POSIX")
@pytest.mark.parametrize("workers", [1, 2])
def test_an_interrupt_keeps_what_is_done(two_joints: Path, tmp_path: Path, workers: int) -> None:
    """Ctrl-C reaches every process of the group, as a terminal sends it."""
    words = [
        "--law",
        "lugre",
        "--law",
        "bittencourt_a",
        "--starts",
        "200",
        "-o",
        str(tmp_path / "out"),
    ]
    line = [sys.executable, "-m", "stribeck", "study", str(two_joints), *words]
    process = subprocess.Popen(
        [*line, "--workers", str(workers)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while fits_in(tmp_path / "out") < 3:
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)
    out, error = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert "Traceback" not in error and "stopped after" in error
    kept = fits_in(tmp_path / "out")
    assert 3 <= kept < 800
    assert (tmp_path / "out" / "fits.parquet").exists()
    while running_in_group(process.pid):
        assert time.monotonic() < deadline
        time.sleep(0.05)

    other = command(two_joints, *words[:-3], 3, *words[-2:])
    assert other.returncode == 2 and "another number of starts (200 there, 3 here)" in other.stderr
    assert fits_in(tmp_path / "out") == kept
