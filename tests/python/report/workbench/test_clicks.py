"""The whole loop by clicks alone, in a real browser."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import stribeck as sb
from browser import PAGES, artefacts, chromium, done, go, press, workbench
from stribeck.motion.generate.demo import demo_path

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[tuple[Any, str]]:
    with workbench(tmp_path, demo_path()) as (_, address), chromium() as page:
        page.goto(address)
        yield page, address


def shoot(page: Any, folder: Path, name: str) -> None:
    """Screenshots of a page as a desktop and a phone show it; nothing may be wider than it."""
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_timeout(700)
        page.screenshot(path=str(folder / f"{name}-{width}.png"), full_page=True)
        wide = page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
        assert wide <= 0, f"{name} is {wide} pixels wider than {width}"
    page.set_viewport_size({"width": 1280, "height": 900})


def faults(page: Any) -> list[str]:
    """What axe finds that keeps people from using the page."""
    import axe_core_python

    script = Path(axe_core_python.__file__).parent / "axe.min.js"
    if not page.evaluate("typeof window.axe !== 'undefined'"):
        # By the debugger: the policy of the page admits no other script.
        page.evaluate(script.read_text())
    found = page.evaluate("axe.run()")
    return [
        f"{row['id']}: {row['nodes'][0]['html'][:200]}"
        for row in found["violations"]
        if row["impact"] in ("serious", "critical")
    ]


def test_the_loop_by_clicks_alone(opened: tuple[Any, str], tmp_path: Path) -> None:
    page, _ = opened
    folder = artefacts(tmp_path / "pictures")
    failed: list[str] = []
    page.on("pageerror", lambda error: failed.append(str(error)))
    page.on("console", lambda m: failed.append(m.text) if m.type == "error" else None)
    done(page)
    go(page, "Check")
    assert "velocity = d(position)/dt" in page.inner_text("main")
    go(page, "Compare")
    press(page, "Compare laws")
    press(page, "Fit this law")
    go(page, "Where")
    page.wait_for_selector("body[data-drawn='1']")
    go(page, "Missing")
    press(page, "Find what is missing")
    assert "load" in page.inner_text("article h2")
    press(page, "Reject saturation")
    assert "saturation is rejected" in page.inner_text("main")
    go(page, "Missing")
    press(page, "Add load")
    assert page.inner_text("tr.current").count("+ load") == 1
    press(page, "Go to node 0")
    page.get_by_label("Effect to add").fill("stribeck")
    press(page, "Add the effect")
    go(page, "Compare")
    page.get_by_label("First model").select_option("1")
    page.get_by_label("Second model").select_option("2")
    press(page, "Compare the two")
    assert "Node 1, coulomb+load, has the smaller" in page.inner_text("main")
    page.reload()
    assert "Node 1, coulomb+load, has the smaller" in page.inner_text("main")
    go(page, "Add")
    press(page, "Go to node 1")
    go(page, "Missing")
    press(page, "Find what is missing")
    go(page, "Prove")
    press(page, "Prove passivity")
    assert "passive" in page.inner_text("pre")
    press(page, "Plan the motion")
    go(page, "Export")
    press(page, "Export the program")
    press(page, "Write the report")
    press(page, "Save the model file")
    wrong = {}
    for title in PAGES:
        go(page, title)
        if page.locator("[data-figure]").count():
            page.wait_for_selector("body[data-drawn='1']")
        wrong[title] = faults(page)
        shoot(page, folder, title.lower())
    assert not any(wrong.values()), wrong
    assert not failed
    kept = tmp_path / "kept"
    project = sb.project(kept / "demo.project.toml")
    assert [node.label for node in project.tree] == ["coulomb", "+ load", "+ stribeck"]
    assert project.current == 1
    assert (kept / "demo-1.report.html").stat().st_size > 100_000
    subprocess.run(
        ["cc", "-std=c99", "-o", "try", "friction.c", "friction_test.c"],
        cwd=kept / "demo-1-c",
        check=True,
    )
    subprocess.run([str(kept / "demo-1-c" / "try")], check=True)


def test_long_work_is_stopped_at_once(opened: tuple[Any, str]) -> None:
    page, _ = opened
    done(page)
    go(page, "Compare")
    press(page, "Fit this law")
    go(page, "Add")
    page.get_by_role("button", name="Add until the rest is noise").click()
    page.get_by_role("button", name="Stop").click()
    done(page)
    assert "Stopped" in page.inner_text("main")
    assert page.locator("tr.current").count() == 1
