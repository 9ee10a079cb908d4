"""A workbench in a process of its own, and a real browser that clicks on it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

#: Longest that an action may take on a busy computer, ms.
PATIENCE = 90_000
#: The command of this environment.
COMMAND = (sys.executable, "-m", "stribeck")
PAGES = ("Data", "Check", "Compare", "Where", "Missing", "Add", "Prove", "Export")


@contextmanager
def workbench(
    folder: Path, *data: str | Path, command: Sequence[str] = COMMAND
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The command with its address; it must end with code 0 on Ctrl-C."""
    words = [*command, "app", *map(str, data), "--no-browser"]
    process = subprocess.Popen(
        [*words, "--folder", str(folder / "kept")], stdout=subprocess.PIPE, text=True, cwd=folder
    )
    try:
        assert process.stdout is not None
        yield process, process.stdout.readline().strip()
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0
    finally:
        process.kill()
        process.wait()


@contextmanager
def chromium(width: int = 1280) -> Iterator[Any]:
    """A page of Debian's Chromium; tests are skipped where there is none."""
    api = pytest.importorskip("playwright.sync_api")
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    if path is None:
        pytest.skip("chromium is not installed (apt-get install chromium)")
    with api.sync_playwright() as tools:
        browser = tools.chromium.launch(
            executable_path=path, args=["--no-sandbox", "--disable-gpu"]
        )
        page = browser.new_page(viewport={"width": width, "height": 900})
        page.set_default_timeout(PATIENCE)
        yield page
        browser.close()


def artefacts(default: Path) -> Path:
    """Where screenshots are kept: the variable STRIBECK_ARTEFACTS, or a temporary folder."""
    folder = Path(os.environ.get("STRIBECK_ARTEFACTS", default))
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def go(page: Any, title: str) -> None:
    """Open a page by its link."""
    page.get_by_role("navigation").get_by_role("link", name=title, exact=True).click()


def press(page: Any, label: str) -> None:
    """Press a button, and wait for what it starts."""
    page.get_by_role("button", name=label, exact=True).first.click()
    done(page)


def done(page: Any) -> None:
    """Wait until no work goes on; no error may be shown."""
    # At every frame: a selector is looked for twice a second only.
    page.wait_for_function("() => document.body.dataset.busy === '0'")
    errors = page.locator("p.error")
    assert errors.count() == 0, errors.all_inner_texts()


def check_exported(folder: Path) -> None:
    """Compile an exported program and run its own test."""
    compile = ["cc", "-std=c99", "-o", "try", "friction.c", "friction_test.c"]
    subprocess.run(compile, cwd=folder, check=True)
    subprocess.run([str(folder / "try")], check=True)
