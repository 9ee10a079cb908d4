"""The page stands alone and holds what was found."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser

import stribeck as sb
from stribeck.report.page import diagnosis_page, improvement_page

VOID = {"meta", "img", "br", "link", "hr"}


class Balanced(HTMLParser):
    """Checks that every element that is opened is closed, in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_pages_stand_alone(improvement: sb.Improvement, diagnosis: sb.Diagnosis) -> None:
    for page in (improvement_page(improvement), diagnosis_page(diagnosis)):
        assert not re.search(r"""(src|href)=["'](?!data:)""", page)
        assert "data:image/png;base64," in page
        parser = Balanced()
        parser.feed(page)
        assert not parser.open


def test_the_page_tells_what_was_found(improvement: sb.Improvement) -> None:
    page = improvement_page(improvement)
    assert "The model coulomb lacks load" in page
    for name in improvement.final.estimates:
        assert f"<code>{name}</code>" in page
    for row in improvement.untestable:
        assert row.effect in page
    assert improvement.final.recording.sha256 in page
    assert ">nan" not in page and "None" not in page.replace("NoneType", "None")


def test_each_finding_has_its_figure(improvement: sb.Improvement, diagnosis: sb.Diagnosis) -> None:
    for page, findings in (
        (improvement_page(improvement), [step.finding for step in improvement.steps]),
        (diagnosis_page(diagnosis), diagnosis.findings),
    ):
        for finding in findings:
            assert f'alt="Residual without and with {finding.effect}' in page
        assert page.count('figure class="finding"') == len(findings) > 0


def test_the_page_of_a_diagnosis(diagnosis: sb.Diagnosis) -> None:
    page = diagnosis_page(diagnosis)
    assert "What the model coulomb lacks most is load" in page
    assert "With load added" in page and "noise floor" in page.lower()
    for row in (*diagnosis.untestable, *diagnosis.smallest_visible):
        assert row.effect in page
    nothing = replace(diagnosis, verdict="none", findings=())
    assert "No effect that this recording can show is missing" in diagnosis_page(nothing)


def test_a_file_name_cannot_break_the_page(improvement: sb.Improvement) -> None:
    page = improvement_page(improvement)
    assert "made &lt;&amp;&gt; odd.parquet" in page
    assert "made <&> odd" not in page


def test_a_page_where_nothing_was_found(improvement: sb.Improvement) -> None:
    nothing = replace(improvement, steps=(), final=improvement.base)
    assert "What was found" not in improvement_page(nothing)
