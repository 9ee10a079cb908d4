"""What a file holds and can show, as text."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.report.diagnosis import untestable_text
from stribeck.report.layout import joined, paragraph, table
from stribeck.report.numbers import listed, plain, thousands
from stribeck.report.recording import scored_sentence

if TYPE_CHECKING:
    from stribeck.diagnosis.inspect import Inspection


def inspection_text(inspection: Inspection) -> str:
    """What a file holds, and which effects it can test."""
    parts = [_heading(inspection), _channels(inspection)]
    if inspection.problem is not None:
        problem = f"Cannot be read as a recording yet: {inspection.problem}"
        return joined(*parts, paragraph(problem, 0))
    testable = f"Can be tested with this data: {listed(inspection.testable) or 'no effect'}."
    return joined(
        *parts,
        *(paragraph(scored_sentence(r), 0) for r in inspection.recordings),
        paragraph(testable, 0),
        untestable_text(inspection.untestable.values()),
    )


def _heading(inspection: Inspection) -> str:
    t = inspection.table
    facts = [f"{thousands(t.rows)} samples", f"{t.runs} run{'s' * (t.runs != 1)}"]
    if t.rate_hz:
        facts.append(f"{plain(t.rate_hz)} Hz")
    if t.gaps:
        facts.append(f"{t.gaps} gap{'s' * (t.gaps != 1)}")
    heading = f"{Path(t.path).name}: {', '.join(facts)}"
    return f"{heading}\n  joints: {', '.join(t.joints)}" if t.joints else heading


def _channels(inspection: Inspection) -> str:
    shown = dict(inspection.table.channels)
    for r in inspection.recordings[:1]:
        shown = {**r.columns, **shown}
    rows = [["channel", "from", "unit", "min", "max"]]
    rows += [
        [name, c.source, c.unit, plain(c.minimum), plain(c.maximum)] for name, c in shown.items()
    ]
    return table(rows, {3, 4})
