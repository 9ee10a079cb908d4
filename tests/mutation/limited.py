"""Run a test under limits of processor time and memory: a change may loop or grow for ever."""

from __future__ import annotations

import os
import resource
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

MOST_MEMORY = 6 * 2**30


def limit(seconds: int) -> None:
    """Limit this process."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def run(
    command: Sequence[str | Path], folder: Path, seconds: int, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[str]:
    """The ended command, with its output as text."""

    return subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        # A test that waits uses no processor time; the computer may be busy with other things.
        timeout=60 * seconds,
        preexec_fn=lambda: limit(seconds),
    )
