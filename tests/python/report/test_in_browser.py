"""A page in Chromium: loads nothing, fits, no serious fault for axe, linked selections."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import stribeck as sb
from stribeck.report.account import of_improvement
from stribeck.report.page import account_page

CHROMIUM = shutil.which("chromium")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Debian's package chromium is not installed"),
]
#: Without a graphics card, WebGL is computed.
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
#: The samples that are selected, in the source that the figures share.
SELECTED = """() => [...Bokeh.documents[0].all_models]
    .filter(model => model.type === "ColumnDataSource" && model.data.row)
    .map(model => model.selected.indices.length)"""
DRAWN = "() => window.Bokeh && Bokeh.documents.length && Bokeh.documents[0].is_idle"


@pytest.fixture(scope="module")
def page(improvement: sb.Improvement, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path: Path = tmp_path_factory.mktemp("page") / "page.html"
    compared = sb.compare([improvement.base, improvement.final], improvement.final.recording)
    account = of_improvement(improvement, compared).made_by("stribeck improve", None)
    path.write_text(account_page(account), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playing:
        started = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield started
        started.close()


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (390, "dark"), (1600, "dark")])
def test_the_page_is_whole(browser: Any, page: Path, width: int, scheme: str) -> None:
    import axe_core_python

    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
    tab = context.new_page()
    asked, errors = [], []
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("console", lambda said: errors.append(said.text) if said.type == "error" else None)
    tab.on("pageerror", lambda error: errors.append(str(error)))
    tab.goto(page.as_uri())
    tab.wait_for_function(DRAWN, timeout=60_000)
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert errors == []
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    tab.evaluate((Path(axe_core_python.__file__).parent / "axe.min.js").read_text())
    found = tab.evaluate("axe.run()")["violations"]
    assert [row["id"] for row in found if row["impact"] in ("serious", "critical")] == []
    context.close()


def test_a_drag_over_time_selects_samples_in_all_figures(browser: Any, page: Path) -> None:
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.goto(page.as_uri())
    tab.wait_for_function(DRAWN, timeout=60_000)
    assert tab.evaluate(SELECTED) == [0]
    drawn = tab.locator("figure", has_text="Torque over time").first
    drawn.scroll_into_view_if_needed()
    box = drawn.bounding_box()
    assert box is not None
    height = box["y"] + 0.6 * box["height"]
    tab.mouse.move(box["x"] + 300, height)
    tab.mouse.down()
    tab.mouse.move(box["x"] + 360, height, steps=4)
    tab.mouse.up()
    tab.wait_for_function(f"() => ({SELECTED})()[0] > 0", timeout=20_000)
    (chosen,) = tab.evaluate(SELECTED)
    assert 0 < chosen < 1000
    tab.close()
