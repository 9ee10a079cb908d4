"""A disk that becomes full at any write: one line, and what was written before is kept.

The operating system injects the failure: with a limit on the size of files a write fails as on a
full disk, with another errno.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb
from synthetic import joint

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="limits of resources are POSIX"),
]


def run(folder: Path, *words: str, bytes_at_most: int | None) -> subprocess.CompletedProcess[str]:
    """A command that can write no file larger than this."""

    def limited() -> None:
        if bytes_at_most is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_at_most, bytes_at_most))

    return subprocess.run(
        [sys.executable, "-m", "stribeck", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        preexec_fn=limited,
        # Matplotlib and numba write caches of their own.
        env={**os.environ, "MPLCONFIGDIR": str(folder / ".matplotlib")},
    )


@pytest.fixture
def home(tmp_path: Path) -> Path:
    joint(rows=1500).write_csv(tmp_path / "joint.csv")
    sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).save(tmp_path / "model.toml")
    return tmp_path


@pytest.mark.parametrize(
    ("words", "made"),
    [
        (("fit", "joint.csv", "--model", "coulomb", "-o", "out.toml"), "out.toml"),
        (("generate", "--seconds", "20", "-o", "out.csv"), "out.csv"),
        (("export", "model.toml", "out", "--to", "c"), "out"),
        (("project", "new", "out.toml", "joint.csv"), "out.toml"),
    ],
    ids=lambda words: words[0] if isinstance(words, tuple) else "",
)
def test_a_file_that_does_not_fit_is_not_begun(
    home: Path, words: tuple[str, ...], made: str
) -> None:
    done = run(home, *words, bytes_at_most=200)
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert "cannot write" in done.stderr.splitlines()[-1]
    left = [path for path in (home / made).rglob("*")] if made == "out" else [home / made]
    assert not any(path.exists() for path in left)
    again = run(home, *words, bytes_at_most=None)
    assert again.returncode == 0, again.stderr


def test_an_old_model_stays(home: Path) -> None:
    before = (home / "model.toml").read_text()
    words = ("fit", "joint.csv", "--model", "lugre", "--starts", "1", "-o", "model.toml")
    assert run(home, *words, bytes_at_most=200).returncode == 2
    assert (home / "model.toml").read_text() == before


def test_a_study_keeps_the_fits_that_fitted(home: Path) -> None:
    words = ("study", "joint.csv", "--law", "coulomb", "--law", "dahl", "--starts", "3",
             "--workers", "1", "-o", "study")  # fmt: skip
    done = run(home, *words, bytes_at_most=1200)
    assert done.returncode == 2 and "Traceback" not in done.stderr, done.stderr
    assert "cannot write" in done.stderr.splitlines()[-1]
    kept = (home / "study" / "fits.csv").read_text().count("\n") - 1
    assert kept >= 1
    again = run(home, *words, bytes_at_most=None)
    assert again.returncode == 0, again.stderr
    assert (home / "study" / "fits.csv").read_text().count("\n") == 1 + 1 + 3
