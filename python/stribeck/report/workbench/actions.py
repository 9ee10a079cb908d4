"""Long actions; each runs in a process of its own and tells how far it is."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from stribeck.base.errors import RecordingError, SpecError
from stribeck.diagnosis.compare import Comparison, compare
from stribeck.diagnosis.inspect import inspect
from stribeck.exporters.export import Export, export
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.motion.design.plan import plan
from stribeck.motion.design.result import Plan
from stribeck.passivity.certificate import Certificate
from stribeck.passivity.check import check
from stribeck.projects.project import Project
from stribeck.projects.sides import Sides
from stribeck.recording.load import read_with
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.whole_file.scan import FileColumn
from stribeck.report.pages.account import of_project
from stribeck.report.pages.recording import account_page
from stribeck.report.workbench.work import Telling
from stribeck.robot.describe import read_robot
from stribeck.robot.improve import improve_robot as improve_joints
from stribeck.robot.motion import read_motion

#: One file, or several that are runs of one joint.
Files: TypeAlias = tuple[str, ...]


@dataclass(frozen=True)
class Looked:
    """What files hold.

    Attributes
    ----------
    said
        The JSON of `stribeck inspect`.
    joints
        Names of all joints.
    """

    said: Mapping[str, object]
    columns: tuple[FileColumn, ...]
    joints: tuple[str, ...]


@dataclass(frozen=True)
class Changed:
    """A project after an action, with the errors of its current model where they were computed."""

    project: Project
    comparison: Comparison | None = None


@dataclass(frozen=True)
class Limits:
    """What a planned motion must keep, in rad or m and s, and what it is for."""

    position: tuple[float, float]
    speed: float
    acceleration: float
    duration: float
    show: tuple[str, ...]
    separate: tuple[str, ...]


@dataclass(frozen=True)
class RobotPage:
    """The page of a whole robot, HTML."""

    text: str


def look(tell: Telling, files: Files, options: ReadOptions) -> Looked:
    """Read files, and say what they hold and can show."""
    tell("said", "Reading the file" if len(files) == 1 else f"Reading {len(files)} files")
    recording: Recording | None = None
    try:
        recording = read_with(files, options)
    except RecordingError:
        # The inspection below says why.
        recording = None
    if recording is not None:
        tell("known", recording)
        # The page draws the recording now: what follows leaves it the processor.
        if hasattr(os, "nice"):
            os.nice(5)
    tell("said", "Checking the channels against each other, and what they can show")
    found = inspect(files, **options.given())
    return Looked(found.to_dict(), found.table.columns, found.table.joints)


def begin(tell: Telling, path: str, data: Files, base: str, options: ReadOptions) -> Changed:
    """Make a project with its base model fitted."""
    tell("said", f"Fitting {base}")
    return _compared(tell, Project.new(path, data, base, **options.given()))


def reopen(tell: Telling, path: str) -> Changed:
    """Open a project file."""
    tell("said", "Reading the project and its data")
    return _compared(tell, Project.open(path))


def where(tell: Telling, project: Project) -> Changed:
    """The errors of the current model, by regime."""
    return _compared(tell, project)


def diagnose(tell: Telling, project: Project) -> Changed:
    """Find what the current model lacks."""
    tell("said", "Trying every effect that the data can show")
    return Changed(_diagnosed(tell, project))


def add(tell: Telling, project: Project, effect: str) -> Changed:
    """Add an effect to the current model."""
    tell("said", f"Adding {effect} and fitting again")
    return _compared(tell, project.add(effect))


def drop(tell: Telling, project: Project, effect: str) -> Changed:
    """Drop an effect of the current model."""
    tell("said", f"Dropping {effect} and fitting again")
    return _compared(tell, project.drop(effect))


def improve(tell: Telling, project: Project) -> Changed:
    """Diagnose and add until what is left is noise; every step is told."""
    made = project.improve(
        progress=lambda sentence: tell("said", sentence),
        each=lambda found: tell("known", Changed(found)),
    )
    return _compared(tell, made)


def compare_laws(tell: Telling, recording: Recording, laws: Sequence[str]) -> Comparison:
    """Fit several laws and compare them."""
    fits: list[Fit] = []
    for law in laws:
        tell("said", f"Fitting {law}")
        fits.append(fit(law, recording))
        tell("known", compare(fits, recording))
    return compare(fits, recording)


def compare_nodes(tell: Telling, project: Project, one: str, other: str) -> Sides:
    """Compare two models of a project."""
    return project.compare(one, other)


def prove(tell: Telling, project: Project, box: Mapping[str, tuple[float, float]]) -> Certificate:
    """Prove that the current model is passive, or find a motion that generates energy."""
    tell("said", "Looking for a proof or a counterexample")
    return check(project.fit, dict(box))


def plan_motion(tell: Telling, project: Project, limits: Limits) -> Plan:
    """Plan a motion that shows or separates effects."""
    tell("said", "Searching for a motion")
    return plan(
        project.fit,
        position=limits.position,
        speed=limits.speed,
        acceleration=limits.acceleration,
        duration=limits.duration,
        show=limits.show,
        separate=limits.separate,
    )


def export_model(
    tell: Telling, project: Project, language: str, precision: str, folder: str
) -> Export:
    """Write the current model as a program."""
    return export(project.fit, language, folder, precision=precision, name="friction")


def page_of(tell: Telling, project: Project, command: str) -> str:
    """The report of the branch that ends at the current model."""
    if project.diagnosis is None:
        tell("said", "Looking for what is still missing")
        project = _diagnosed(tell, project)
        tell("known", Changed(project))
    tell("said", "Writing the page")
    fits = [project.fit_of(node) for node in project.tree.path(project.current)]
    diagnosis = project.diagnosis
    if diagnosis is None:
        raise SpecError("the model has no diagnosis: press Find what is missing first")
    account = of_project(project, diagnosis, compare(fits, project.recording))
    return account_page(account.made_by(command, check(project.fit)))


def improve_robot(tell: Telling, files: Files, described: str, options: ReadOptions) -> RobotPage:
    """Identify a whole robot and add what its joints lack; returns the page of it."""
    # matplotlib is slow to import.
    from stribeck.report.pages.robot import robot_improvement_page

    tell("said", "Reading all joints")
    motion = read_motion(read_robot(described), files, replace(options, joint=None))
    for recording in motion.joints:
        recording.require_consistent()
    found = improve_joints(motion, progress=lambda sentence: tell("said", sentence))
    tell("said", "Writing the page")
    command = shlex.join(["stribeck", "robot", "improve", *files, "--robot", described])
    return RobotPage(robot_improvement_page(found, command))


def _compared(tell: Telling, project: Project) -> Changed:
    fitted = project.fit
    tell("known", Changed(project))
    tell("said", "Looking where the model fails")
    return Changed(project, compare([fitted], project.recording))


def _diagnosed(tell: Telling, project: Project) -> Project:
    """Diagnose the current model; its findings are told before what else the data can show."""

    def known(found: Project) -> None:
        tell("known", Changed(found))
        tell("said", "Looking at what is left, and at what this data could show")

    return project.diagnose(progress=lambda sentence: tell("said", sentence.strip()), known=known)
