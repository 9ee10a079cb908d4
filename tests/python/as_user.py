"""The command, run as a user runs it: in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any


def stribeck(*words: object) -> subprocess.CompletedProcess[str]:
    """Run the command."""
    command = [sys.executable, "-m", "stribeck", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)


def answer(*words: object) -> dict[str, Any]:
    """The one JSON object that a command prints."""
    done = stribeck(*words, "--json")
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert isinstance(made, dict)
    return made
