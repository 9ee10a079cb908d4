"""The main texts and pages, whole, on the recording that is shipped with the package.

After a wanted change of words: ``pytest tests/python/report/test_snapshots.py --snapshot-update``,
then read the difference.
"""

from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest
import stribeck as sb
from stribeck.cli.demo import BASE, tell
from stribeck.diagnosis.inspect import inspect
from stribeck.motion.generate.demo import demo_path, demo_recording
from stribeck.report.catalog import catalog_text
from stribeck.report.inspection import inspection_text
from stribeck.report.pages.recording import diagnosis_page, improvement_page
from syrupy.assertion import SnapshotAssertion


@pytest.fixture(scope="session")
def improved() -> sb.Improvement:
    """The loop on the shipped recording."""
    return sb.improve(BASE, sb.read(demo_path()))


@pytest.fixture(scope="session")
def diagnosed(improved: sb.Improvement) -> sb.Diagnosis:
    """What the base model lacks."""
    return sb.diagnose(improved.base)


def steady(text: str) -> str:
    """`text` without times, counts of evaluations, version and folder."""
    text = re.sub(r"\d+ evaluations, \d+\.\d s", "N evaluations, T s", text)
    text = text.replace(f"stribeck {sb.__version__}", "stribeck VERSION")
    return text.replace(str(demo_path()), "demo.parquet")


class Words(HTMLParser):
    """The words of a page, one element a line."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = []
        self.silent = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.silent = tag in ("style", "script")
        if tag == "img":
            self.lines.append(f"[{dict(attrs)['alt']}]")

    def handle_endtag(self, tag: str) -> None:
        self.silent = False

    def handle_data(self, data: str) -> None:
        if data.strip() and not self.silent:
            self.lines.append(" ".join(data.split()))


def words(page: str) -> str:
    """The words of a page, without the versions of what it was made with."""
    parser = Words()
    # An equation is one line, not one a symbol.
    parser.feed(re.sub(r"<math.*?</math>", lambda found: re.sub("<[^>]+>", "", found[0]), page))
    lines = [line for line in parser.lines if not line.startswith("stribeck ") or "," not in line]
    return steady("\n".join(lines))


def test_inspection(snapshot: SnapshotAssertion) -> None:
    assert steady(inspection_text(inspect(demo_path()))) == snapshot


def test_fit(improved: sb.Improvement, snapshot: SnapshotAssertion) -> None:
    assert steady(repr(improved.final)) == snapshot


def test_comparison(improved: sb.Improvement, snapshot: SnapshotAssertion) -> None:
    compared = sb.compare([improved.base, improved.final], improved.final.recording)
    assert steady(repr(compared)) == snapshot


def test_diagnosis(diagnosed: sb.Diagnosis, snapshot: SnapshotAssertion) -> None:
    assert steady(repr(diagnosed)) == snapshot


def test_improvement(improved: sb.Improvement, snapshot: SnapshotAssertion) -> None:
    assert steady(repr(improved)) == snapshot


def test_addition(improved: sb.Improvement, snapshot: SnapshotAssertion) -> None:
    added = sb.Addition("load", improved.base, improved.steps[0].after)
    assert steady(repr(added)) == snapshot


def test_demo(improved: sb.Improvement, snapshot: SnapshotAssertion) -> None:
    compared = sb.compare([improved.base], improved.base.recording)
    assert tell(improved, compared, demo_recording()[1]) == snapshot


@pytest.mark.slow
def test_pages(
    improved: sb.Improvement, diagnosed: sb.Diagnosis, snapshot: SnapshotAssertion
) -> None:
    assert words(improvement_page(improved)) == snapshot
    assert words(diagnosis_page(diagnosed)) == snapshot


@pytest.mark.parametrize(
    "model",
    [
        sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5),
        sb.model("coulomb", coulomb_friction=-2.0, viscous_friction=0.5),
        sb.model("coulomb+offset", coulomb_friction=2.0, viscous_friction=0.5, offset=0.1),
    ],
    ids=["passive", "not passive", "not only friction"],
)
def test_certificate(model: sb.Model, snapshot: SnapshotAssertion) -> None:
    assert repr(sb.check(model, box={"velocity": (-2.0, 2.0)})) == snapshot


def test_catalog(snapshot: SnapshotAssertion) -> None:
    row = {
        "id": "load",
        "title": "Load",
        "formula": "c |tl| sgn(v)",
        "group": "friction",
        "what": "The load presses the contacts together.",
        "parameters": [{"name": "load_coulomb", "symbol": "lc", "unit": "1"}],
        "needs": ["load_torque", "velocity"],
    }
    assert catalog_text([row], "needs") == snapshot
