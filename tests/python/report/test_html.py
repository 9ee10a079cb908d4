"""The pages stand alone, hold what was found, and let nothing of the data act as markup."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.models.catalog import catalog
from stribeck.report.diagnosis import diagnosis_summary
from stribeck.report.pages.account import of_comparison
from stribeck.report.pages.equations import beside, symbols
from stribeck.report.pages.mathml import mathml
from stribeck.report.pages.recording import account_page, diagnosis_page, improvement_page

VOID = {"meta", "img", "br", "link", "hr"}


class Elements(HTMLParser):
    """Checks that every element that is opened is closed, and keeps what it could load."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loaded: list[str] = []
        self.ids: set[str] = set()
        self.scripts = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        self.scripts += tag == "script"
        for name, value in attrs:
            if name in ("src", "href", "srcset", "data", "action", "poster"):
                self.loaded.append(value or "")
            if name == "id":
                self.ids.add(value or "")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def elements(page: str) -> Elements:
    parser = Elements()
    parser.feed(page)
    assert not parser.open
    return parser


@pytest.fixture(scope="module")
def improved(improvement: sb.Improvement) -> str:
    return improvement_page(improvement)


@pytest.fixture(scope="module")
def diagnosed(diagnosis: sb.Diagnosis) -> str:
    return diagnosis_page(diagnosis)


def test_pages_stand_alone(improved: str, diagnosed: str) -> None:
    for page in (improved, diagnosed):
        found = elements(page)
        assert found.loaded
        for address in found.loaded:
            assert address.startswith("data:") or address[1:] in found.ids
        style = re.findall(r"<style>.*?</style>", page, re.DOTALL)
        assert not re.search(r"url\(|@import", "".join(style))


def test_the_page_tells_what_was_found(improvement: sb.Improvement, improved: str) -> None:
    assert "The model coulomb lacks load" in improved
    for name in improvement.final.estimates:
        assert f"<code>{name}</code>" in improved
    for row in improvement.untestable:
        assert row.effect in improved
    assert improvement.final.recording.sha256 in improved
    assert ">nan" not in improved and ">None<" not in improved


def test_every_part_is_there(improvement: sb.Improvement, improved: str) -> None:
    ids = elements(improved).ids
    assert {"found", "measured", "model", "left", "passivity", "data", "repeat"} <= ids
    assert improved.count("<math") > 3
    assert f"stribeck {sb.__version__}" in improved and "SHA-256" in improved


def test_each_finding_has_its_figure(
    improvement: sb.Improvement, diagnosis: sb.Diagnosis, improved: str, diagnosed: str
) -> None:
    for page, findings in (
        (improved, [step.finding for step in improvement.steps]),
        (diagnosed, diagnosis.findings),
    ):
        for finding in findings:
            assert f"<figcaption>Residual without and with {finding.effect};" in page
        assert page.count('figure class="finding"') == len(findings) > 0


def test_the_page_of_a_diagnosis(diagnosis: sb.Diagnosis, diagnosed: str) -> None:
    assert "What the model coulomb lacks most is load" in diagnosed
    assert "With load added" in diagnosed and "noise floor" in diagnosed.lower()
    for row in (*diagnosis.untestable, *diagnosis.smallest_visible):
        assert row.effect in diagnosed
    nothing = replace(diagnosis, verdict="none", findings=(), demoted=(), not_claimed=())
    assert "No effect that this recording can show is missing" in diagnosis_page(nothing)


def test_no_more_than_noise_is_said_to_be_noise(diagnosis: sb.Diagnosis) -> None:
    doubted = replace(diagnosis, verdict="unexplained", findings=(), demoted=diagnosis.findings)
    noise = replace(doubted, unexplained=replace(doubted.unexplained, share=0.0))
    structure = replace(doubted, unexplained=replace(doubted.unexplained, share=0.9))
    assert "leaves more than noise" in diagnosis_summary(structure)
    assert "No effect is claimed to be missing" in diagnosis_summary(noise)


def test_only_symbols_of_the_equations_are_told(plain: sb.Recording) -> None:
    law, effect = (sb.fit(spec, plain, starts=1).model for spec in ("coulomb", "coulomb+stribeck"))
    assert beside(law) == []
    assert beside(effect)[0].startswith("An arrow")
    own = replace(law, rigid_body=("inertia",))
    assert "load torque or force" in [meaning for _, meaning in symbols(own)]


def test_a_check_without_a_result_has_a_mark_of_its_own(
    improvement: sb.Improvement, improved: str
) -> None:
    checks = improvement.final.recording.checks
    count = sum(check.is_open for check in checks)
    assert count > 0
    assert improved.count('<li class="open">') == count
    assert improved.count('<li class="ok">') == len(checks) - count


def test_the_equations_are_told_with_their_constants(improved: str) -> None:
    assert "This model does not have ls and lv" in improved
    assert re.search(r"Constants, in SI units: reference_load = \d", improved)


def test_a_file_name_cannot_break_the_page(improved: str) -> None:
    assert "made &lt;&amp;&gt; odd.parquet" in improved
    assert "made <&> odd" not in improved


@pytest.mark.slow
def test_names_of_files_and_columns_are_text(plain: sb.Recording, tmp_path: Path) -> None:
    bad = "<script>alert(1)</script>"
    column = replace(plain.columns["torque"], source=bad)
    named = replace(
        plain,
        path=f"{tmp_path}/{bad}.csv",
        joint=bad,
        columns={**plain.columns, "torque": column},
        notes=(bad,),
    )
    fitted = sb.fit("coulomb", named, starts=1)
    page = account_page(of_comparison(sb.compare([fitted], named, floor=False)).made_by(bad, None))
    assert bad not in page and "&lt;script&gt;alert(1)" in page
    plain_page = of_comparison(sb.compare([sb.fit("coulomb", plain, starts=1)], plain, floor=False))
    assert elements(page).scripts == elements(account_page(plain_page)).scripts


def test_a_page_where_nothing_was_found(improvement: sb.Improvement) -> None:
    nothing = replace(improvement, steps=(), final=improvement.base)
    assert "Step by step" not in improvement_page(nothing)


def test_steady_state_points_have_a_page(steady: sb.Fit) -> None:
    page = account_page(of_comparison(sb.compare([steady], steady.recording)))
    assert "one steady-state point a run" in page


def test_formulas_of_the_catalog_become_mathml() -> None:
    """Most are set; the few with prose in them remain text, and all is well-formed and escaped."""
    rows = [*catalog()["laws"].values(), *catalog()["effects"].values()]
    statements = [one for row in rows for one in mathml(str(row["formula"]))]
    for one in statements:
        elements(one)
    text = [s for s in statements if re.fullmatch(r"<math[^>]*><mtext>[^<]*</mtext></math>", s)]
    assert len(text) <= 10 < len(statements) - len(text)
    assert "<script" not in mathml("<script>alert(1)</script>")[0]
