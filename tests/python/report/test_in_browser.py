"""A page in Chromium: loads nothing, fits, no serious fault for axe, linked selections."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import stribeck as sb
from in_chromium import faults, keep, wider
from stribeck.cli.main import main
from stribeck.report.pages.account import of_improvement
from stribeck.report.pages.recording import account_page
from stribeck.report.pages.robot import robot_improvement_page
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import RobotMotion
from synthetic import joint

CHROMIUM = shutil.which("chromium")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Debian's package chromium is not installed"),
]
#: Canvases are painted by the processor: without a graphics card this takes a third of the time
#: that an emulated card takes.
FLAGS = ["--no-sandbox", "--disable-gpu"]
#: The samples that are selected, in the source that the figures share.
SELECTED = """() => [...Bokeh.documents[0].all_models]
    .filter(model => model.type === "ColumnDataSource" && model.data.row)
    .map(model => model.selected.indices.length)"""
#: Whether the figure in an element is painted: those out of sight are not.
PAINTED = """place => Object.values(Bokeh.index)
    .some(view => place.contains(view.el) && !view.model.hold_render)"""
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
    assert wider(tab) + faults(tab) == []
    keep(tab, f"report-improve-{width}.png")
    context.close()


def test_printed_figures_fit_the_paper(browser: Any, page: Path) -> None:
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.goto(page.as_uri())
    tab.wait_for_function(DRAWN, timeout=60_000)
    tab.emulate_media(media="print")
    tab.set_viewport_size({"width": 700, "height": 900})
    tab.wait_for_selector("canvas.printed")
    pictures = tab.locator("canvas.printed")
    assert pictures.count() == tab.locator("figure").count() > 8
    fits = "all => all.every(one => one.clientWidth <= one.closest('figure').clientWidth)"
    assert pictures.evaluate_all(fits)
    tab.emulate_media(media="screen")
    tab.wait_for_function("() => document.querySelector('canvas.printed') === null")
    tab.close()


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory, motion: RobotMotion) -> Path:
    """A folder with one page of each other kind."""
    folder: Path = tmp_path_factory.mktemp("reports")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for day in (1, 2):
            joint(rows=1200, seed=day).write_csv(f"arm-2024-01-0{day}.csv")
        run, days = "arm-2024-01-01.csv", "arm-*.csv"
        made = ("--workers", "1")
        for words in (
            ("fit", run, "lugre"),
            ("compare", run, "coulomb", "coulomb+offset"),
            ("diagnose", run, "coulomb"),
            ("study", run, "--law", "coulomb", "--law", "dahl", *made, "-o", "study"),
            ("fleet", days, "coulomb", *made, "-o", "fleet", "--name", "{robot}-{day}.csv"),
        ):
            main([*words, "--report", f"{words[0]}.html"])
    found = improve_robot(motion, most_steps=0)
    (folder / "robot-improve.html").write_text(robot_improvement_page(found), encoding="utf-8")
    return folder


def test_pages_of_every_kind(browser: Any, reports: Path) -> None:
    tab = browser.new_page()
    wrong = {}
    for page in sorted(reports.glob("*.html")):
        for width in (1280, 390):
            tab.set_viewport_size({"width": width, "height": 900})
            tab.goto(page.as_uri())
            if tab.evaluate("() => typeof window.Bokeh !== 'undefined'"):
                tab.wait_for_function(DRAWN, timeout=60_000)
            found = wider(tab) + faults(tab)
            wrong |= {f"{page.stem} at {width}": found} if found else {}
            keep(tab, f"report-{page.stem}-{width}.png")
    assert len(list(reports.glob("*.html"))) == 6
    assert wrong == {}
    tab.close()


def test_a_drag_over_time_selects_samples_in_all_figures(browser: Any, page: Path) -> None:
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.goto(page.as_uri())
    tab.wait_for_function(DRAWN, timeout=60_000)
    assert tab.evaluate(SELECTED) == [0]
    drawn = tab.locator("figure", has_text="Torque over time").first
    drawn.scroll_into_view_if_needed()
    # A figure answers a drag after it was painted.
    tab.wait_for_function(PAINTED, arg=drawn.element_handle(), timeout=20_000)
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
