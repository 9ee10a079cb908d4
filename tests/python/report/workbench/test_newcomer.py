"""From a fresh clone to a compiled controller: README's commands, then the workbench by clicks."""

from __future__ import annotations

import os
import re
import runpy
import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest
import stribeck as sb
from browser import artefacts, check_exported, chromium, done, go, press, workbench

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs"))
from command_lines import ROOT, lines

SHARED = ROOT.parent / "shared"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1200),
    pytest.mark.skipif(not (ROOT / ".git").exists(), reason="this is no git checkout"),
    pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler"),
]
#: What README calls a recording.
MADE = "generate -o LOG.csv --effect load --effect stribeck --seconds 30 --rate 50"


def cloned(folder: Path) -> Path:
    """A clone whose `.venv` is as `develop.py setup` leaves it.

    Its libraries are those of this environment, and the extension module is the one built here: the
    build itself is what this environment went through. The package is that of the clone.
    """
    clone = folder / "stribeck"
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
    venv.create(clone / ".venv", symlinks=True)
    (site,) = (clone / ".venv/lib").glob("python*/site-packages")
    libraries = sysconfig.get_paths()["purelib"]
    (site / "stribeck.pth").write_text(f"{clone / 'python'}\n{libraries}\n")
    for built in (ROOT / "python/stribeck").glob("_core*"):
        shutil.copy(built, clone / "python/stribeck")
    script = (Path(sys.executable).parent / "stribeck").read_text().splitlines()
    command = clone / ".venv/bin/stribeck"
    command.write_text("\n".join([f"#!{clone / '.venv/bin/python'}", *script[1:]]) + "\n")
    command.chmod(0o755)
    task = runpy.run_path(str(clone / "develop.py"), run_name="tasks")
    task["STAMP"].write_text(task["fingerprint"]())
    return clone


def run(clone: Path, line: str) -> str:
    """A line of README in a shell with the environment activated; returns what it prints."""
    path = f"{clone / '.venv/bin'}{os.pathsep}{os.environ['PATH']}"
    ended = subprocess.run(
        ["bash", "-c", line],
        cwd=clone,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, f"{line}\n{ended.stderr[-2000:]}"
    return ended.stdout


def test_from_a_clone_to_a_compiled_controller(tmp_path: Path) -> None:
    clone = cloned(tmp_path)
    where = run(clone, "python -c 'import stribeck; print(stribeck.__file__)'")
    assert Path(where.strip()).is_relative_to(clone)
    commands_of_the_readme(clone)
    if not SHARED.is_dir():
        pytest.skip("published measurements are not at ../shared: no clicks on them")
    (tmp_path / "shared").symlink_to(SHARED)
    a_robot_joint_by_clicks(clone, artefacts(tmp_path / "pictures"))


def commands_of_the_readme(clone: Path) -> None:
    """All of them but the workbench, which the clicks below are for."""
    first = [line.text for line in lines() if line.page == "README.md"]
    assert first[0] == "python3 develop.py demo"
    assert "The same effects were\nfound." in run(clone, first[0])
    run(clone, f"stribeck {MADE}")
    rest = [line for line in first if line.startswith("stribeck ")]
    for line in rest:
        if not line.startswith(("stribeck demo", "stribeck app")):
            run(clone, line)
    for made in ("why.html", "joint.html", "report.html", "joint.toml", "controller/joint.c"):
        assert (clone / made).stat().st_size > 0
    assert len(rest) >= 9


def a_robot_joint_by_clicks(clone: Path, pictures: Path) -> None:
    """Find and add the load of a UR10e's joint; save the report; compile and test its program."""
    command = [str(clone / ".venv/bin/stribeck")]
    with workbench(clone, "../shared/data/ur10e", command=command) as (_, address):
        with chromium() as page:
            page.goto(address)
            done(page)
            # The folder is open as runs; one recording of it has joint 2 in motion.
            file = page.locator("li", has_text="joint_2.parquet")
            file.get_by_role("button", name="Open", exact=True).click()
            done(page)
            page.get_by_role("button", name="Joint 2", exact=True).click()
            page.wait_for_selector("body[data-busy='0']")
            go(page, "Check")
            page.get_by_label("torque constant").fill("10.6956")
            press(page, "Read the file again")
            go(page, "Compare")
            press(page, "Fit this law")
            go(page, "Missing")
            press(page, "Find what is missing")
            assert "load" in page.inner_text("article h2")
            page.wait_for_selector("body[data-drawn='1']")
            page.screenshot(path=str(pictures / "newcomer-missing.png"), full_page=True)
            press(page, "Add load")
            assert "+ load" in page.inner_text("tr.current")
            go(page, "Export")
            for button in ("Write the report", "Save the model file", "Export the program"):
                press(page, button)
    kept = clone / "kept"
    (program,) = kept.glob("*-c")
    check_exported(program)
    (report,) = kept.glob("*.report.html")
    assert re.search(r"Friction of ur-20_01_22-joint_2", report.read_text())
    (model,) = kept.glob("*.model.toml")
    assert sb.load(model).has("load")
