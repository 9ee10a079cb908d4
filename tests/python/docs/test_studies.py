"""The scripts behind the tables and figures of the documentation load as the package is now."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[2]
SCRIPTS = [
    path for folder in ("studies", "real") for path in sorted((TESTS / folder).rglob("*.py"))
]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_a_script_loads(script: Path) -> None:
    load = f"import runpy; runpy.run_path({str(script)!r}, run_name='loaded')"
    done = subprocess.run(
        [sys.executable, "-c", load],
        cwd=TESTS.parent,
        env={"PYTHONPATH": str(script.parent), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
