"""The whole loop by clicks alone, in a real browser."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import psutil
import pytest
import stribeck as sb
from browser import PAGES, artefacts, check_exported, chromium, done, go, press, workbench
from in_chromium import faults, wider
from stribeck.cli.main import main
from stribeck.motion.generate.demo import demo_path
from synthetic import joint

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[tuple[Any, str]]:
    with workbench(tmp_path, demo_path()) as (_, address), chromium() as page:
        page.goto(address)
        yield page, address


def shoot(page: Any, folder: Path, name: str) -> list[str]:
    """Screenshots of a page as a desktop and a phone show it; returns where it is too wide."""
    found = []
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_timeout(700)
        page.screenshot(path=str(folder / f"{name}-{width}.png"), full_page=True)
        found += wider(page)
    page.set_viewport_size({"width": 1280, "height": 900})
    return found


def hold(page: Any, address: str) -> list[Any]:
    """The requests of an address that are held until they are continued."""
    held: list[Any] = []
    page.route(address, lambda route: held.append(route))
    return held


def wait(page: Any, held: list[Any]) -> None:
    """Wait for a request that is held."""
    while not held:
        page.wait_for_timeout(50)


@pytest.mark.minutes
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
    assert "passive" in page.inner_text("div.answer")
    press(page, "Plan the motion")
    assert "demo-1.motion.csv" in page.inner_text("p.done")
    go(page, "Export")
    press(page, "Export the program")
    press(page, "Write the report")
    press(page, "Save the model file")
    wrong = {}
    for title in PAGES:
        go(page, title)
        if page.locator("[data-figure]").count():
            page.wait_for_selector("body[data-drawn='1']")
        wrong[title] = [*faults(page), *shoot(page, folder, title.lower())]
    assert not any(wrong.values()), wrong
    assert not failed
    kept = tmp_path / "kept"
    project = sb.project(kept / "demo.project.toml")
    assert [node.label for node in project.tree] == ["coulomb", "+ load", "+ stribeck"]
    assert project.current == 1
    assert (kept / "demo-1.report.html").stat().st_size > 100_000
    check_exported(kept / "demo-1-c")


def test_a_page_gets_what_is_new_in_its_place(opened: tuple[Any, str]) -> None:
    page, _ = opened
    page.get_by_label("Path of a recording").fill("/tmp/other.csv")
    page.wait_for_selector("[data-figure='time'] .bk-Figure")
    page.evaluate("() => { document.querySelector('[data-figure=time]').kept = true; }")
    done(page)
    assert page.get_by_label("Path of a recording").input_value() == "/tmp/other.csv"
    page.wait_for_function("() => document.body.dataset.drawn === '1'")
    assert page.evaluate("() => document.querySelector('[data-figure=time]').kept")
    go(page, "Compare")
    press(page, "Fit this law")
    go(page, "Missing")
    page.get_by_role("button", name="Find what is missing", exact=True).click()
    page.wait_for_selector("[data-figure='findings'] .bk-Figure")
    page.evaluate("() => { document.querySelector('[data-figure=findings]').kept = true; }")
    done(page)
    page.wait_for_function("() => document.body.dataset.drawn === '1'")
    assert page.evaluate("() => document.querySelector('[data-figure=findings]').kept")
    assert "Cannot be tested" in page.inner_text("main")


def test_other_figures_undo_nothing(opened: tuple[Any, str]) -> None:
    page, _ = opened
    done(page)
    go(page, "Compare")
    press(page, "Fit this law")
    go(page, "Add")
    page.get_by_label("Effect to add").fill("load")
    press(page, "Add the effect")
    page.wait_for_function("() => document.body.dataset.drawn === '1'")
    held = hold(page, "**/figures/**")
    press(page, "Go to node 0")
    page.get_by_label("Effect to add").fill("stribeck")
    page.evaluate("() => { document.body.kept = true; }")
    wait(page, held)
    held[-1].continue_()
    page.unroute("**/figures/**")
    page.wait_for_selector("[data-figure='errors'] .bk-Figure")
    page.wait_for_timeout(1000)
    assert page.evaluate("() => document.body.kept")
    assert page.get_by_label("Effect to add").input_value() == "stribeck"


def test_late_figures_keep_no_one_on_a_page(opened: tuple[Any, str]) -> None:
    page, _ = opened
    done(page)
    go(page, "Compare")
    press(page, "Fit this law")
    library, other = hold(page, "**/bokeh.min.js*"), hold(page, "**/compare?*")
    go(page, "Add")
    page.get_by_label("Effect to add").fill("load")
    press(page, "Add the effect")
    page.evaluate("() => document.querySelector('nav a[href*=compare]').click()")
    wait(page, other)
    wait(page, library)
    library[-1].continue_()
    page.unroute("**/bokeh.min.js*")
    page.wait_for_timeout(2000)
    other[-1].continue_()
    page.wait_for_url("**/compare?*", timeout=5000)


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


def test_runs_of_an_arm_by_clicks(tmp_path: Path) -> None:
    paths = [tmp_path / f"run{k}.csv" for k in (1, 2)]
    for seed, path in enumerate(paths):
        arm(seed).write_csv(path)
    folder = artefacts(tmp_path / "pictures")
    with workbench(tmp_path) as (_, address), chromium() as page:
        page.goto(address)
        page.get_by_label("Drop a recording").set_input_files(paths)
        page.get_by_role("button", name="Open what is chosen").click()
        done(page)
        go(page, "Data")
        assert "Each file holds 2 joints" in page.inner_text("main")
        assert [*faults(page), *shoot(page, folder, "joints")] == []
        press(page, "Joint 2")
        page.wait_for_selector("body[data-drawn='1']")
        assert page.get_by_role("checkbox", checked=True).count() == 2
        assert [*faults(page), *shoot(page, folder, "runs")] == []
        go(page, "Compare")
        press(page, "Fit this law")
        go(page, "Data")
        page.get_by_role("checkbox").first.uncheck()
        press(page, "Open the ticked as runs of one joint")
        assert "run2.csv: no law fitted yet" in page.inner_text("header")
    project = sb.project(tmp_path / "kept" / "run1-and-1-more-joint-2.project.toml")
    assert project.recording.run_names == ("run1", "run2")
    assert project.recording.joint == "2"


def arm(seed: int) -> pl.DataFrame:
    """A file of two joints."""
    channels = {"position": "q", "velocity": "dq", "torque": "tau"}
    parts = [joint(rows=1500, seed=2 * seed + k).select("time", *channels) for k in (0, 1)]
    named = [
        part.rename({channel: f"{name}_{k}" for channel, name in channels.items()})
        for k, part in enumerate(parts, 1)
    ]
    return pl.concat([named[0], named[1].drop("time")], how="horizontal")


def test_a_million_samples(tmp_path: Path) -> None:
    path = tmp_path / "million.parquet"
    million(path)
    with workbench(tmp_path) as (process, address), chromium() as page:
        page.goto(address)
        page.get_by_label("Path of a recording").fill(str(path))
        began = time.monotonic()
        page.get_by_role("button", name="Open", exact=True).first.click()
        page.wait_for_selector("body[data-drawn='1']")
        opened = time.monotonic() - began
        page.wait_for_selector("body[data-busy='0']")
        page.wait_for_selector("body[data-drawn='1']")
        zooms = [zoomed(page, 10.0 * k, 10.0 * k + 100.0 / (k + 1)) for k in range(15)]
        go(page, "Compare")
        press(page, "Fit this law")
        go(page, "Where")
        page.wait_for_selector("body[data-drawn='1']")
        before = processor_seconds()
        brushes = brushed(page, 15)
        used = (processor_seconds() - before) / len(brushes)
        zooms_of_all = [zoomed(page, 10.0 * k, 10.0 * k + 100.0 / (k + 1)) for k in range(15)]
        largest = psutil.Process(process.pid).memory_info().rss / 1e6
    zoom, brush, of_all = map(statistics.median, (zooms, brushes, zooms_of_all))
    said = (
        f"open {opened:.2f} s, zoom {zoom:.0f} ms, with a model: brush {brush:.0f} ms "
        f"({1000.0 * used:.0f} ms of all processors), zoom {of_all:.0f} ms, {largest:.0f} MB"
    )
    (artefacts(tmp_path / "pictures") / "million.txt").write_text(said)
    assert largest < 1000.0, said
    # Times are those of a computer that does nothing else: here only that none is absurd.
    assert opened < 60.0 and max(zoom, brush, of_all) < 2000.0, said


def test_the_first_finding_on_a_minute(tmp_path: Path) -> None:
    path = tmp_path / "minute.csv"
    main(["generate", "-o", str(path), "--effect", "load", "--seconds", "60", "--rate", "500"])
    with workbench(tmp_path) as (_, address), chromium() as page:
        page.goto(address)
        page.get_by_label("Path of a recording").fill(str(path))
        began, times = time.monotonic(), {}
        press(page, "Open")
        times["open and checked"] = time.monotonic() - began
        go(page, "Compare")
        press(page, "Fit this law")
        times["law fitted"] = time.monotonic() - began
        go(page, "Missing")
        page.get_by_role("button", name="Find what is missing", exact=True).click()
        page.wait_for_function("() => document.querySelector('article h2') !== null")
        times["finding"] = time.monotonic() - began
        first = page.inner_text("article h2")
        page.wait_for_function("() => document.body.dataset.drawn === '1'")
        times["finding drawn"] = time.monotonic() - began
        done(page)
        times["all told"] = time.monotonic() - began
    said = ", ".join(f"{what} {seconds:.2f} s" for what, seconds in times.items())
    (artefacts(tmp_path / "pictures") / "minute.txt").write_text(said)
    assert "(load)" in first
    # Times are those of a computer that does nothing else: here only that none is absurd.
    assert times["finding drawn"] < 120.0, said


def processor_seconds() -> float:
    """Processor time of the browser and the workbench so far, s."""
    times = [process.cpu_times() for process in psutil.Process().children(recursive=True)]
    return sum(time.user + time.system for time in times)


def brushed(page: Any, count: int) -> list[float]:
    """Drag over time `count` times; the times until all figures have marked the samples, ms."""
    page.evaluate(
        """() => {
            const source = Bokeh.documents[0].get_model_by_name("samples");
            let released = 0;
            window.brushes = [];
            document.addEventListener("pointerup", () => { released = performance.now(); }, true);
            source.selected.properties.indices.change.connect(() => {
                const began = released;
                // One frame asks for the paint of all figures, the next one ends after it.
                requestAnimationFrame(() => requestAnimationFrame(
                    () => brushes.push(performance.now() - began)));
            });
        }"""
    )
    drawn = page.locator("[data-figure='time'] .plot")
    drawn.scroll_into_view_if_needed()
    box = drawn.bounding_box()
    assert box is not None
    height = box["y"] + 0.6 * box["height"]
    for k in range(count):
        left = box["x"] + 150 + 40 * k
        page.mouse.move(left, height)
        page.mouse.down()
        page.mouse.move(left + 30, height, steps=3)
        page.mouse.up()
        page.wait_for_function(f"() => brushes.length > {k}")
        page.wait_for_timeout(150)
    times: list[float] = page.evaluate("() => brushes")
    return times


def test_a_selection_outlives_a_zoom(opened: tuple[Any, str]) -> None:
    page, _ = opened
    page.wait_for_selector("body[data-drawn='1']")
    done(page)
    page.wait_for_selector("body[data-drawn='1']")
    brushed(page, 1)
    first, last = page.evaluate(CHOSEN)
    assert last > first
    zoomed(page, first - 1.0, last + 1.0)
    again = page.evaluate(CHOSEN)
    zoomed(page, last + 5.0, last + 6.0)
    assert page.evaluate(CHOSEN) == []
    zoomed(page, first - 2.0, last + 2.0)
    assert again == page.evaluate(CHOSEN) == pytest.approx([first, last])


#: First and last time of the samples that are selected.
CHOSEN = """() => {
    const source = Bokeh.documents[0].get_model_by_name("samples");
    const times = source.selected.indices.map((k) => source.data.time[k]);
    return times.length ? [Math.min(...times), Math.max(...times)] : [];
}"""


def million(path: Path) -> None:
    """A joint at 1 kHz for a thousand seconds."""
    rows = 1_000_000
    t = np.arange(rows) / 1000.0
    v = 1.5 * np.sin(0.7 * t) + 0.5 * np.sin(2.3 * t)
    q = np.cumsum(v) / 1000.0
    noise = np.random.default_rng(0).standard_normal((2, rows))
    torque = 5.0 * np.tanh(v / 0.01) + 2.0 * v + 1.5 * np.gradient(v, 0.001) + 0.3 * noise[0]
    columns = {"time": t, "position": q, "velocity": v + 1e-4 * noise[1], "torque": torque}
    pl.DataFrame(columns).write_parquet(path)


def zoomed(page: Any, start: float, end: float) -> float:
    """Zoom the axis of time; the time until the samples of that stretch are drawn, ms."""
    return float(
        page.evaluate(
            """([start, end]) => new Promise((done) => {
                const bokeh = Bokeh.documents[0], began = performance.now();
                const range = bokeh.get_model_by_name("window");
                const source = bokeh.get_model_by_name("samples");
                const drawn = () => {
                    source.properties.data.change.disconnect(drawn);
                    requestAnimationFrame(() => done(performance.now() - began));
                };
                source.properties.data.change.connect(drawn);
                range.setv({ start, end });
            })""",
            [start, end],
        )
    )
