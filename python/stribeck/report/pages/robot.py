"""Pages on robots: errors, what each joint has and lacks, rigid bodies, joint by joint."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.effect.describe import physically
from stribeck.report.diagnosis import doubts
from stribeck.report.interactive.base import AXES_SPAN
from stribeck.report.numbers import (
    confidence_words,
    listed,
    percent,
    plain,
    thousands,
    unit_text,
)
from stribeck.report.pages.figures import figures_of, robot_plots
from stribeck.report.pages.recording import sections_page
from stribeck.report.pages.robot_headline import (
    comparison_headline,
    diagnosis_headline,
    fit_headline,
    improvement_headline,
)
from stribeck.report.pages.sections import Section
from stribeck.report.parameters import interval_text, parameter_rows
from stribeck.report.robot import (
    NO_CAUSES,
    added_rows,
    base_rows,
    bodies_sentence,
    causes_rows,
    errors_legend,
    errors_rows,
    evaluated_rows,
    lacking_rows,
)
from stribeck.report.robot_payload import drive_gains_rows, payload_sentence

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from stribeck.diagnosis.result import Diagnosis, Finding
    from stribeck.models.model import Model
    from stribeck.robot.compare import RobotComparison
    from stribeck.robot.diagnosis import RobotDiagnosis
    from stribeck.robot.improve import RobotImprovement, RobotStep
    from stribeck.robot.result import JointFit, RobotFit

#: Said of an effect that a joint shows alone, and that does not hold with all joints identified.
NOT_ADDED = "Found on this joint alone, and not added: "


def robot_fit_page(found: RobotFit, command: str = "") -> str:
    """A page on an identified robot.

    Parameters
    ----------
    command
        The command that made it.
    """
    sections = [_errors(found), *_evaluated(found), *_joints(found, {}, {}), _bodies(found)]
    about = "rigid bodies and friction of all joints"
    return _page(found, about, fit_headline(found), sections, command)


def robot_comparison_page(compared: RobotComparison, command: str = "") -> str:
    """A page on several models of all joints; the figure is of the last one."""
    last = compared.fits[-1]
    heading = ["joint", *compared.specs]
    rows = [
        [joint.joint, *(percent(fit.joints[k].relative_residual_held_out) for fit in compared.fits)]
        for k, joint in enumerate(last.joints)
    ]
    held_out = last.solved.balance.held_out
    said = [f"Held-out residual over torque, both filtered; held out by {held_out}."]
    said += [
        f"{listed(specs)}: {sentence[:1].lower()}{sentence[1:]}"
        for sentence, specs in _bodies_of_models(compared).items()
    ]
    sections = []
    for spec, found in zip(compared.specs, compared.fits, strict=True):
        tables = [evaluated_rows(found.joints, row) for row in found.evaluated]
        names = [f"{Path(row.path).name}, not fitted." for row in found.evaluated]
        if tables:
            sections.append(Section(spec, names, tables))
    sections += _joints(last, {}, {})
    return _page(
        last,
        "models of all joints side by side",
        comparison_headline(compared),
        sections,
        command,
        first=[Section("Models side by side", said, [[heading, *rows]])],
    )


def _bodies_of_models(compared: RobotComparison) -> dict[str, list[str]]:
    """What is said of the rigid bodies, with the models of which it is said."""
    said: dict[str, list[str]] = {}
    for spec, found in zip(compared.specs, compared.fits, strict=True):
        said.setdefault(bodies_sentence(found), []).append(spec)
    return said


def robot_diagnosis_page(found: RobotDiagnosis, command: str = "") -> str:
    """A page on what every joint lacks, before anything is added."""
    causes = causes_rows(found.rigid_body)
    said = [] if found.rigid_body else [NO_CAUSES]
    tables = [rows for rows in (lacking_rows(found), causes) if len(rows) > 1]
    sections = [
        Section("What is missing", said, tables),
        _errors(found.fit),
        *_joints(found.fit, {}, found.joints),
        _bodies(found.fit),
    ]
    headline = diagnosis_headline(found)
    return _page(found.fit, "what every joint lacks", headline, sections, command)


def robot_improvement_page(found: RobotImprovement, command: str = "") -> str:
    """A page on what every joint lacked, and the robot with it."""
    final, added = found.final, added_rows(found)
    causes = causes_rows(found.rigid_body)
    said = [] if len(added) > 1 else ["No effect is added."]
    said += [] if found.rigid_body else [NO_CAUSES]
    tables = [rows for rows in (added, causes) if len(rows) > 1]
    sections = [
        Section("What was missing", said, tables),
        _errors(final),
        *_evaluated(final),
        *_joints(final, found.steps, found.last, of_the_rest=NOT_ADDED),
        _bodies(final),
    ]
    headline = improvement_headline(found)
    return _page(final, "what every joint lacks", headline, sections, command)


def _page(
    found: RobotFit,
    about: str,
    headline: str,
    sections: Sequence[Section],
    command: str,
    first: Sequence[Section] = (),
) -> str:
    """A page whose figures are of `found`."""
    balance = found.solved.balance
    motion = balance.motion
    names = balance.run_names
    runs = f"runs {', '.join(names)}" if len(names) > 1 else "one run"
    specs = list(dict.fromkeys(joint.model.spec for joint in found.joints))
    of = f"Figures show {specs[0]}. " if len(specs) == 1 else ""
    return sections_page(
        balance.base.robot.name,
        about,
        headline,
        figures_of(robot_plots(found)),
        sections,
        command,
        beside=[
            f"{len(found.joints)} joints, {thousands(balance.rows)} samples, {runs}. Both sides of "
            f"the torque balance pass a low-pass at {motion.cutoff:.3g} Hz.",
            f"{of}{AXES_SPAN}",
        ],
        first=first,
    )


def _errors(found: RobotFit) -> Section:
    held_out = found.solved.balance.held_out
    rows = errors_rows(found.joints, found.ordinary)
    return Section("Errors of the joints", [errors_legend(held_out)], [rows])


def _evaluated(found: RobotFit) -> list[Section]:
    return [
        Section(
            f"{Path(row.path).name}, not fitted",
            ["Nothing was fitted to this recording, and nothing was chosen by it."],
            [evaluated_rows(found.joints, row)],
        )
        for row in found.evaluated
    ]


def _joints(
    found: RobotFit,
    steps: Mapping[str, Sequence[RobotStep]],
    last: Mapping[str, Diagnosis],
    of_the_rest: str = "",
) -> list[Section]:
    """One section a joint: its model, what was added and why, its parameters.

    Parameters
    ----------
    of_the_rest
        What is said before a finding of `last`.
    """
    made = []
    for joint in found.joints:
        said = [
            f"Model {joint.model.spec}; held-out RMSE {plain(joint.rmse_held_out)} "
            f"{unit_text(joint.model.torque_unit)}."
        ]
        said += [_step(step) for step in steps.get(joint.joint, ())]
        if joint.joint in last:
            said += _verdict(last[joint.joint], of_the_rest)
        made.append(Section(f"Joint {joint.joint}", said, [_parameters(joint)]))
    return made


def _step(step: RobotStep) -> str:
    errors = (step.before.rmse_held_out, step.after.rmse_held_out)
    return _evidence(step.finding, step.after.model, *errors)


def _finding(found: Finding) -> str:
    errors = (found.rmse_held_out_before, found.rmse_held_out_after)
    return _evidence(found, found.fit.model, *errors)


def _evidence(found: Finding, model: Model, before: float, after: float) -> str:
    """An effect in words: cause, error without and with it, where it shows, what may be it."""
    where = f" {found.where[:1].upper()}{found.where[1:]}." if found.where else ""
    others = found.indistinguishable_from
    ties = f" On this data it cannot be told from {' or '.join(others)}." if others else ""
    return (
        f"{found.effect}, {confidence_words(found.confidence)}: "
        f"{physically(found.effect, model)} Held-out RMSE {plain(before)} → {plain(after)} "
        f"{unit_text(model.torque_unit)}.{where}{ties}"
    )


def _verdict(last: Diagnosis, of_the_rest: str) -> list[str]:
    """What a joint lacks, what remains of it, and what its motion cannot show."""
    said = [f"{of_the_rest}{_finding(one)}" for one in last.findings]
    if last.verdict == "unexplained":
        said.append("Structure remains in its residual that no effect explains beyond doubt.")
    said += [f"{heading}: {' '.join(sentences)}" for heading, sentences in doubts(last)]
    if last.untestable:
        names = ", ".join(row.effect for row in last.untestable)
        said.append(f"This motion cannot show: {names}.")
    return said


def _parameters(joint: JointFit) -> list[list[str]]:
    estimates = list(joint.estimates.values())
    heading = [
        "parameter",
        "symbol",
        "value",
        "standard error",
        "95 % interval",
        "unit",
        "relative",
        "note",
    ]
    rows = zip(parameter_rows(estimates), estimates, strict=True)
    return [heading, *([*row[:4], interval_text(e), *row[4:]] for row, e in rows)]


def _bodies(found: RobotFit) -> Section:
    said = [bodies_sentence(found)]
    if found.payload is not None:
        said.append(payload_sentence(found.payload, found.drive_gains))
    hidden = found.solved.balance.base.not_shown
    if hidden:
        said.append(f"Without effect on any torque: {', '.join(hidden)}.")
    tables = [base_rows(found)]
    if found.drive_gains:
        said.append("Drive gains are those that a known payload shows.")
        tables.append(drive_gains_rows(found.drive_gains))
    return Section("Rigid bodies", said, tables)
