"""Outputs never take the place of an input, or of a file of another kind."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.base.errors import StribeckError
from stribeck.base.files import write_whole
from synthetic import joint


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A recording with a sidecar."""
    path = tmp_path / "log.csv"
    joint(rows=600).write_csv(path)
    sidecar = tmp_path / "log.csv.sidecar.toml"
    sidecar.write_text('kind = "recording"\njoint_kind = "revolute"\n')
    return path


@pytest.mark.parametrize(
    "words",
    [
        ("fit", "LOG", "--model", "coulomb", "-o", "LOG"),
        ("fit", "LOG", "--model", "coulomb", "-o", "LOG.sidecar.toml"),
        ("improve", "LOG", "-o", "LOG"),
        ("improve", "LOG", "--report", "LOG"),
        ("improve", "LOG", "--plot", "LOG"),
        ("diagnose", "LOG", "coulomb", "--report", "LOG"),
        ("compare", "LOG", "coulomb", "--plot", "LOG"),
        ("add", "coulomb", "stribeck", "LOG", "-o", "LOG"),
        ("points", "LOG", "--method", "averaging", "-o", "LOG"),
        ("fit", "LOG", "--model", "coulomb", "-o", "OTHER"),
        ("improve", "LOG", "--report", "OTHER"),
    ],
)
def test_an_output_never_replaces_data(log: Path, words: tuple[str, ...]) -> None:
    other = log.with_name("other.csv")
    other.write_bytes(log.read_bytes())
    before = {path: path.read_bytes() for path in log.parent.iterdir()}
    named = [w.replace("LOG", str(log)).replace("OTHER", str(other)) for w in words]
    done = subprocess.run(
        [sys.executable, "-m", "stribeck", *named], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1 and "cannot write" in done.stderr
    assert {path: path.read_bytes() for path in log.parent.iterdir()} == before


def test_a_page_is_html_by_its_name_too(log: Path) -> None:
    page = log.with_name("page.png")
    words = ["improve", str(log), "--report", str(page)]
    done = subprocess.run(
        [sys.executable, "-m", "stribeck", *words], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"stribeck: cannot write {page}: its name must end in .html or .htm\n"
    assert not page.exists()


def test_a_model_file_replaces_a_model_file(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    sb.model("coulomb", coulomb_friction=1.0, viscous_friction=1.0).save(str(path))
    sb.model("coulomb", coulomb_friction=2.0, viscous_friction=1.0).save(str(path))
    assert sb.load(path).value("coulomb_friction") == 2.0


def test_a_link_keeps_naming_its_file_which_keeps_its_mode(tmp_path: Path) -> None:
    target, link = tmp_path / "kept.txt", tmp_path / "link.txt"
    target.write_text("before")
    target.chmod(0o640)
    link.symlink_to(target)
    write_whole(link, "after")
    assert link.is_symlink() and target.read_text() == "after"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_a_new_file_follows_the_umask(tmp_path: Path) -> None:
    before = os.umask(0o077)
    try:
        write_whole(tmp_path / "new.txt", "text")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new.txt").stat().st_mode) == 0o600


def test_a_device_stays_a_device(tmp_path: Path) -> None:
    with pytest.raises(StribeckError, match="not a regular file"):
        write_whole("/dev/null", "text")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
