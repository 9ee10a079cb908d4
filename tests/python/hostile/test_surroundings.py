"""Terminals, pipes, variables and signals, in processes of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hostile.contract import MOST

COMMAND = (sys.executable, "-m", "stribeck")
FIT = ("fit", "log.csv", "--model", "coulomb")
NOT_WINDOWS = pytest.mark.skipif(os.name == "nt", reason="signals and devices of POSIX")


def start(words: tuple[str, ...], **options: object) -> subprocess.CompletedProcess[bytes]:
    """Run the command in a process."""
    return subprocess.run((*COMMAND, *words), capture_output=True, check=False, **options)


def refused(done: subprocess.CompletedProcess[bytes], said: str) -> None:
    """Code 2, one line, nothing on stdout."""
    (line,) = [x for x in done.stderr.decode().splitlines() if not x.startswith("note: ")]
    assert (done.returncode, done.stdout or b"") == (2, b"")
    assert said in line and len(line) <= MOST and "defect" not in line


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "cp437", "cp850", "koi8-r", "utf-16"])
def test_every_encoding_shows_the_result(workspace: Path, encoding: str) -> None:
    done = start(FIT, env={**os.environ, "PYTHONIOENCODING": encoding})
    assert done.returncode == 0, done.stderr
    assert "coulomb_friction" in done.stdout.decode(encoding)


@pytest.mark.parametrize("name", ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "POLARS_MAX_THREADS"])
@pytest.mark.parametrize("said", ["x", "-1", "0", "1e3", "9" * 40])
def test_threads_are_a_number(workspace: Path, name: str, said: str) -> None:
    refused(start(("models",), env={**os.environ, name: said}), name)


def test_a_window_of_matplotlib_plays_no_part(workspace: Path) -> None:
    words = ("compare", "log.csv", "coulomb", "--plot", "new.png")
    done = start(words, env={**os.environ, "MPLBACKEND": "nonsense"})
    assert done.returncode == 0, done.stderr
    (workspace / "new.png").unlink()


@NOT_WINDOWS
def test_a_full_device(workspace: Path) -> None:
    with open("/dev/full", "wb") as full:
        done = subprocess.run((*COMMAND, *FIT), stdout=full, stderr=subprocess.PIPE, check=False)
    refused(done, "No space left")


@NOT_WINDOWS
def test_a_folder_that_is_gone(workspace: Path) -> None:
    (workspace / "gone").mkdir()
    script = f"cd gone && rmdir ../gone && {sys.executable} -m stribeck models"
    done = subprocess.run(["sh", "-c", script], capture_output=True, check=False)
    refused(done, "the working folder is gone")


@NOT_WINDOWS
def test_too_many_open_files(workspace: Path) -> None:
    script = f"ulimit -n 12; {' '.join((sys.executable, '-m', 'stribeck', *FIT))}"
    refused(subprocess.run(["sh", "-c", script], capture_output=True, check=False), "Too many open")


@NOT_WINDOWS
@pytest.mark.slow
@pytest.mark.parametrize("after", [0.3, 0.6, 1.0, 1.5, 2.5])
def test_ctrl_c_says_what_was_written(workspace: Path, after: float) -> None:
    words = ("improve", "log.csv", "-o", "new.toml")
    with subprocess.Popen((*COMMAND, *words), stderr=subprocess.PIPE) as process:
        time.sleep(after)
        process.send_signal(signal.SIGINT)
        text = process.communicate()[1].decode()
    written = (workspace / "new.toml").exists()
    (workspace / "new.toml").unlink(missing_ok=True)
    assert "Traceback" not in text
    if process.returncode == 130:
        assert ("new.toml was written" if written else "nothing was written") in text
    else:
        assert process.returncode == 0 and written
