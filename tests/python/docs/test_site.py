"""The documentation as it is built: strict, and without a serious fault for axe in Chromium."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from in_chromium import KEPT, faults, keep, wider

ROOT = Path(__file__).resolve().parents[3]
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.minutes,
    pytest.mark.timeout(600),
    pytest.mark.skipif(CHROMIUM is None, reason="Debian's package chromium is not installed"),
]
#: A page of each kind, in dark colours as on a phone; in light colours on a desktop all are tried.
KINDS = (
    "api/errors",
    "api/identification",
    "controller",
    "effects",
    "index",
    "measured/emps",
    "people/firmware_engineer",
    "people/researcher",
    "robots",
    "rust",
)


#: Commands of which a part can only be seen by scrolling.
CUT_OFF = """[...document.querySelectorAll(".language-console code")]
    .filter(code => code.scrollWidth > code.clientWidth + 1).map(code => code.innerText)"""


def cut_off(tab: Any) -> list[str]:
    """Commands that do not go on in the next line."""
    return [f"cut off: {command}" for command in tab.evaluate(CUT_OFF)]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    words = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "--site-dir"]
    subprocess.run([*words, str(folder)], cwd=ROOT, check=True)
    return folder


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playing:
        started = playing.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


def test_no_page_has_a_serious_fault(browser: Any, site: Path) -> None:
    pages = {path.parent.relative_to(site).as_posix(): path for path in site.rglob("index.html")}
    pages["index"] = pages.pop(".")
    assert len(pages) > 40 and set(KINDS) - set(pages) <= {"measured/emps"}
    wrong: dict[str, list[str]] = {}
    commands = 0
    # One test: the site is built once, in whichever process the test runs.
    for width, scheme, names in ((1280, "light", pages), (390, "dark", pages if KEPT else KINDS)):
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
        tab = context.new_page()
        tab.set_default_timeout(90_000)
        for name in sorted(set(names) & set(pages)):
            tab.goto(pages[name].as_uri())
            found = faults(tab) + wider(tab) + cut_off(tab)
            wrong |= {f"{name} at {width}": found} if found else {}
            commands += tab.locator(".language-console code").count()
            keep(tab, f"docs-{name.replace('/', '-')}-{width}.png")
        context.close()
    assert wrong == {} and commands > 0
