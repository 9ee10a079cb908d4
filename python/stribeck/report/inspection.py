"""What a file holds and can show, as text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.recording.several.paths import run_name
from stribeck.report.diagnosis import untestable_text
from stribeck.report.layout import bullets, joined, paragraph, table
from stribeck.report.numbers import listed, plain, thousands
from stribeck.report.recording import scored_sentence
from stribeck.report.transmission import transmission_text

if TYPE_CHECKING:
    from stribeck.diagnosis.inspect import Inspection
    from stribeck.fitting.protocols.found import Protocol
    from stribeck.recording.check import Check


#: How many of the columns that are not read are listed.
_PROPOSED = 12


def inspection_text(inspection: Inspection, spell: Callable[[str], str] = str) -> str:
    """What a file holds, whether its channels agree, and which effects it can test.

    Parameters
    ----------
    spell
        Writes the options in its sentences.
    """
    parts = [_heading(inspection), _files(inspection), _channels(inspection)]
    if inspection.problem is not None:
        problem = spell(f"Cannot be read as a recording yet: {inspection.problem}")
        parts += [paragraph(problem, 0)]
    parts += [_checked(inspection, spell), _not_read(inspection)]
    parts += [
        transmission_text(spell(t) if isinstance(t, str) else t, name)
        for name, t in inspection.transmissions.items()
    ]
    parts += [_protocols(name, found) for name, found in inspection.protocols.items()]
    if inspection.problem is not None:
        return joined(*parts)
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


def _files(inspection: Inspection) -> str:
    """Each of several files, with the run that it is."""
    if not inspection.files:
        return ""
    rows = [["run", "file", "samples", "rate Hz", "gaps"]]
    rows += [
        [
            run_name(t.path),
            t.path,
            thousands(t.rows),
            plain(t.rate_hz) if t.rate_hz else "",
            "" if t.gaps is None else str(t.gaps),
        ]
        for t in inspection.files
    ]
    return table(rows, {2, 3, 4})


def _checked(inspection: Inspection, spell: Callable[[str], str]) -> str:
    """Where the channels contradict each other, where they agree, and what nothing can decide."""
    wrong = [_with_remedy(check) for check in inspection.checks if not check.ok]
    passed = [check.said for check in inspection.checks if check.ok and not check.is_open]
    undecided = [_with_remedy(check) for check in inspection.checks if check.is_open]
    return joined(
        bullets("The channels contradict each other:", map(spell, wrong)),
        bullets("Checks passed:", map(spell, passed)),
        bullets("Checks without a result:", map(spell, undecided)),
    )


def _with_remedy(check: Check) -> str:
    return f"{check.said}: {check.do}" if check.do else check.said


def _not_read(inspection: Inspection) -> str:
    """The columns that are not read and may hold a channel."""
    rows = [
        f"{row.column}: {row.channel}?" + (f" (unit: {row.unit})" if row.unit else "")
        for row in inspection.proposed[:_PROPOSED]
    ]
    left = len(inspection.proposed) - _PROPOSED
    return bullets("Not read:", [*rows, *([f"and {left} more"] if left > 0 else [])])


def _protocols(joint: str, found: tuple[Protocol, ...]) -> str:
    """The test-bench protocols of a joint, and how each becomes points."""
    of = f" of {joint_called(joint)}" if joint else ""
    heading = f"Protocols{of}, which `stribeck points --method METHOD` turns into points:"
    rows = [f"{p.method}: {p.count} {p.says}" for p in found]
    return bullets(heading, rows)


def _channels(inspection: Inspection) -> str:
    channels = dict(inspection.table.channels)
    for r in inspection.recordings[:1]:
        channels = {**r.columns, **channels}
    rows = [["channel", "from", "unit", "min", "max"]]
    rows += [
        [name, c.source, c.unit, plain(c.minimum), plain(c.maximum)] for name, c in channels.items()
    ]
    return table(rows, {3, 4})
