"""One writer at a time: other processes are refused, and a killed one holds nothing."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from stribeck.base.errors import StribeckError
from stribeck.base.lock import one_writer, take

HOLDS = """
import sys, time
from stribeck.base.lock import one_writer
with one_writer(sys.argv[1]):
    print("held", flush=True)
    time.sleep(600)
"""


def test_a_second_writer_is_refused_until_the_first_is_killed(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    other = subprocess.Popen(
        [sys.executable, "-c", HOLDS, str(path)], stdout=subprocess.PIPE, text=True
    )
    assert other.stdout is not None and other.stdout.readline() == "held\n"
    with pytest.raises(StribeckError, match=r"another command is changing .*joint\.toml"):
        with one_writer(path):
            pytest.fail("two writers")
    other.send_signal(signal.SIGKILL)
    other.communicate(timeout=60)
    with one_writer(path):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_lock_is_released_once(tmp_path: Path) -> None:
    first = take(tmp_path / ".lock", "busy")
    first.release()
    second = take(tmp_path / ".lock", "busy")
    first.release()
    with pytest.raises(StribeckError, match="busy"):
        take(tmp_path / ".lock", "busy")
    second.release()


def test_a_folder_that_does_not_exist_is_left_to_the_command(tmp_path: Path) -> None:
    with one_writer(tmp_path / "none" / "joint.toml"):
        pass
    assert not (tmp_path / "none").exists()
