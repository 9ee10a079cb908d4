"""A page on a study: the errors of every law on every joint, and what was skipped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.report.interactive.study_errors import study_errors
from stribeck.report.numbers import MINUS, plain
from stribeck.report.pages.figures import figures_of
from stribeck.report.pages.recording import sections_page
from stribeck.report.pages.sections import Section
from stribeck.report.study import error_rows, heading_sentence, note_lines

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.scale.study.result import Study, Table


def _errors(study: Study, table: Table, speeds: str, low: bool) -> list[list[str]]:
    """The errors of a table by joint; the heading names the speeds and the units."""
    heading, *rows = error_rows(study, table.rows, list(study.joints), low)
    units = [data.torque_unit for data in study.joints.values()]
    of = ["" if joint is None else "joint " for joint in study.joints]
    named = [
        f"{word}{name} [{unit}]" for word, name, unit in zip(of, heading[1:], units, strict=True)
    ]
    return [[f"law, {speeds}", *named], *rows]


def study_page(study: Study, command: str = "") -> str:
    """The whole result as a page; no table is shortened.

    Parameters
    ----------
    command
        The command that made it.
    """
    plots: dict[str, figure] = {}
    for joint, data in study.joints.items():
        of = "" if joint is None else f", {joint_called(joint)}"
        slow = f"|v| < {plain(data.low_speed, 2)} {data.velocity_unit}"
        plots[f"All speeds{of}"] = study_errors(study, joint)
        plots[f"Low speed, {slow}{of}"] = study_errors(study, joint, low_speed=True)
    sections = []
    for each in study.tables:
        speeds = (("all speeds", False), ("low speed", True))
        tables = [_errors(study, each, name, low) for name, low in speeds]
        said = [f"Mean and standard deviation of the error, measured {MINUS} modelled."]
        sections.append(Section(each.group.title, said, tables))
    sections.append(Section("Notes", note_lines(study), []))
    return sections_page(
        f"Study in the folder {study.folder.name}",
        "errors of many laws",
        heading_sentence(study),
        figures_of(plots),
        sections,
        command,
    )
