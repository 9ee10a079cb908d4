"""A fleet that is killed keeps what it has reported as done, and the next run continues."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb
from fleet_logs import answers

#: The command in a terminal, where it shows its progress.
IN_A_TERMINAL = """
import sys, stribeck as sb
def shown(done, total):
    print(done, total, flush=True)
sb.fleet(sys.argv[2:], sys.argv[1], "coulomb", workers=1, progress=shown)
"""


@pytest.mark.slow
@pytest.mark.parametrize("after", [1, 6])
def test_what_the_progress_says_is_done_is_on_the_disk(
    logs: list[Path], tmp_path: Path, after: int
) -> None:
    files = list(map(str, logs[:7]))
    folder = tmp_path / "fleet"
    process = subprocess.Popen(
        [sys.executable, "-c", IN_A_TERMINAL, str(folder), *files],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    for line in process.stdout:
        assert re.fullmatch(r"\d+ 14\n", line)
        if int(line.split()[0]) == after:
            process.send_signal(signal.SIGKILL)
            break
    process.communicate(timeout=60)
    kept = answers(folder).height
    assert after <= kept < 14

    found = sb.fleet(files, folder, "coulomb", workers=1)
    assert found.new == 14 - kept
    sb.fleet(files, tmp_path / "whole", "coulomb", workers=1)
    assert answers(folder).equals(answers(tmp_path / "whole"))
    assert len(list((folder / "results").iterdir())) == 1
