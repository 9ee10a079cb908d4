"""A study as text: the tables of the review, with units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.report.layout import line_width, paragraph, table
from stribeck.report.numbers import MINUS, listed, minus_signs, plain, thousands

if TYPE_CHECKING:
    from stribeck.fitting.energy import Energy
    from stribeck.scale.study.assess import Spread
    from stribeck.scale.study.result import Row, Study, Table

PLUS_MINUS = "\N{PLUS-MINUS SIGN}"


def study_text(study: Study) -> str:
    """The whole result."""
    parts = [heading_sentence(study)]
    for each in study.tables:
        parts += ["", each.group.title, "", *_error_tables(study, each)]
        if any(row.energy is not None for row in each.rows):
            parts += ["", *_energy_table(each)]
    parts += ["", *note_lines(study)]
    return "\n".join(parts).rstrip()


def heading_sentence(study: Study) -> str:
    """What was fitted, in one sentence."""
    plan = study.plan
    fits = f"{thousands(study.frame.height)} fits"
    if study.frame.height < len(plan.jobs):
        fits += f" of {thousands(len(plan.jobs))} (not complete)"
    return (
        f"{Path(plan.path).name or plan.path}: "
        f"{len(plan.laws)} law{'s' if len(plan.laws) > 1 else ''}, "
        f"{len(study.joints)} joint{'s' if len(study.joints) > 1 else ''}, up to {plan.starts} "
        f"start{'s' if plan.starts > 1 else ''} each, {fits}"
    )


def spread_text(spread: Spread, digits: int) -> str:
    """``mean ± standard deviation`` with `digits` decimals."""
    if spread.rows == 0:
        return "no samples"
    return f"{_signed(spread.mean, digits)} {PLUS_MINUS} {spread.std:.{digits}f}"


def _signed(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}"
    if float(text) == 0.0:
        text = text.removeprefix("-")
    return minus_signs(text)


def _error_tables(study: Study, each: Table) -> list[str]:
    """Mean and standard deviation by joint: all speeds, then low speed."""
    lines: list[str] = []
    joints = list(study.joints)
    names = ", ".join(dict.fromkeys(d.torque_unit for d in study.joints.values()))
    lows = dict.fromkeys(
        f"{plain(d.low_speed, 2)} {d.velocity_unit}" for d in study.joints.values()
    )
    for title, low in (
        (f"torque error, measured {MINUS} modelled, all speeds [{names}]", False),
        (f"torque error at low speed, |v| < {' or '.join(lows)} [{names}]", True),
    ):
        lines += [f"  {title}"] if not lines else ["", f"  {title}"]
        blocks = -(-len(joints) // max(1, (line_width() - 20) // 16))
        per_block = -(-len(joints) // blocks)
        for at in range(0, len(joints), per_block):
            cells = error_rows(study, each.rows, joints[at : at + per_block], low)
            lines += ["", table(cells, right=range(1, len(cells[0])))]
    return lines


def error_rows(
    study: Study, rows: Sequence[Row], joints: Sequence[str | None], low: bool
) -> list[list[str]]:
    """A heading, and mean and standard deviation of the error of each law, by joint."""
    heading = ["law", *(f"mean {PLUS_MINUS} std" if j is None else j for j in joints)]
    cells = [heading]
    for row in rows:
        line = [row.law]
        for joint in joints:
            entry = row.entries.get(joint)
            if entry is None:
                line.append("skipped")
            else:
                spread = entry.low_speed if low else entry.whole
                line.append(spread_text(spread, _digits(study, joint)))
        cells.append(line)
    return cells


def _digits(study: Study, joint: str | None) -> int:
    """Decimals that show the smallest error of a joint with three digits, in all its tables."""
    errors = [entry.whole.std for _, _, of, entry in study.entries() if of == joint]
    smallest = min((e for e in errors if e > 0.0), default=1.0)
    return min(max(2 - math.floor(math.log10(smallest)), 0), 6)


def _energy_table(each: Table) -> list[str]:
    rows = [["law", "modelled [J]", "measured [J]", "error [J]", "error [%]"]]
    for row in each.rows:
        if row.energy is not None:
            rows.append([row.law, *energy_cells(row.energy)])
    return [
        f"  electrical energy of the scored samples, all joints (error: measured {MINUS} modelled)",
        "",
        table(rows, right=range(1, 5)),
    ]


def energy_cells(energy: Energy) -> list[str]:
    """Modelled, measured, error in J and in per cent."""
    return [
        plain(energy.modelled, 5),
        plain(energy.measured, 5),
        _signed(energy.error, 2),
        _signed(energy.error_percent, 2),
    ]


def note_lines(study: Study) -> list[str]:
    """What was skipped, what failed, and where the files are."""
    lines: list[str] = []
    if study.skipped:
        lines += ["Skipped:", *_skipped(study)]
    if study.failed:
        lines.append(f"Failed fits: {len(study.failed)}")
        seen: dict[tuple[str | None, str], int] = {}
        for t in study.failed:
            seen[(t.job.joint, t.job.law)] = seen.get((t.job.joint, t.job.law), 0) + 1
        for (joint, law), count in seen.items():
            first = next(t for t in study.failed if (t.job.joint, t.job.law) == (joint, law))
            where = law if joint is None else f"{law} on {joint}"
            lines.append(paragraph(f"{where}: {count}, the first because {first.failure}"))
    if all(row.energy is None for each in study.tables for row in each.rows):
        lines.append(
            paragraph(
                "No electrical energy: it needs the motor constants km, kb and kt and the gear "
                "ratio of every joint; give them as options or in the sidecar.",
                0,
            )
        )
    lines.append(f"All fits, tables and figures are in {study.folder}.")
    return lines


def _skipped(study: Study) -> list[str]:
    """Laws that were not fitted, those with the same reason together."""
    joints: dict[tuple[str, str], list[str | None]] = {}
    for s in study.skipped:
        reason = s.why.replace(s.law, "the law", 1)
        joints.setdefault((reason, s.law), []).append(s.joint)
    laws: dict[str, list[str]] = {}
    for (reason, law), on in joints.items():
        everywhere = len(on) == len(study.joints)
        laws.setdefault(reason, []).append(law if everywhere else f"{law} on {_joints(on)}")
    return [paragraph(f"{listed(of)}: {reason}", hang=2) for reason, of in laws.items()]


def _joints(names: Sequence[str | None]) -> str:
    return listed([name for name in names if name is not None])
