"""`stribeck report`: everything about a recording and its models in one page."""

from __future__ import annotations

import os
from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.base.replaceable import kind_of
from stribeck.cli.common import (
    OF_DATA,
    echo_json,
    json_option,
    model_fit,
    read_recording,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of_both, split
from stribeck.cli.outputs import PAGE, CheckedCommand
from stribeck.cli.pages import write_account
from stribeck.cli.refused import OF_A_SPEC, refusing
from stribeck.cli.unread import refuse_unread
from stribeck.diagnosis.compare import compare
from stribeck.diagnosis.loop.improve import improve
from stribeck.fitting.result import Fit
from stribeck.projects.project import Project
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.improvement import summary_sentence
from stribeck.report.pages.account import error_of, of_improvement, of_project

#: Bytes from which the kind of a file shows.
_HEAD = 4096


@click.command(cls=CheckedCommand)
@arguments_of_both
@click.option(
    "--model",
    "specs",
    multiple=True,
    metavar="SPEC|M.toml",
    help="A model to compare; may be repeated. The best one is improved. [default: coulomb]",
)
@click.option(
    "-o",
    "--output",
    type=PAGE,
    default=None,
    metavar="FILE",
    help="The page (HTML). [default: name of DATA with .report.html]",
)
@refusing(OF_A_SPEC)
@starts_option
@recording_options
@seed_option
@json_option
def report(
    arguments: tuple[str, ...],
    specs: tuple[str, ...],
    output: str | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Write one page on DATA and its models, or on a PROJECT, that works without a network.

    It holds what was recorded, the models with their equations and parameters, where each fails,
    which effects are missing, what could not be tested, passivity, and how to repeat it. Figures
    can be zoomed; samples selected in one are marked in all.
    """
    path = output or _default(arguments[0])
    if is_project(arguments[0]):
        if len(arguments) > 1 or specs:
            raise SpecError("a project has its models: name no other data or models beside it")
        refuse_unread("for a project, which has its data", dict.fromkeys(OF_DATA, "with DATA"))
        made = _of_project(arguments[0], path, seed)
    else:
        made = _of_data(arguments, specs, reading, path, starts=starts, seed=seed)
    if as_json:
        echo_json({"report": path, **made})
    else:
        click.echo(f"{made['summary']}\nReport: {path}")


def is_project(argument: str) -> bool:
    """Whether an argument names a project file."""
    if not os.path.isfile(argument):
        return False
    with open(argument, "rb") as stream:
        return kind_of(stream.read(_HEAD)) == "project file"


def _default(argument: str) -> str:
    """The page's name in the folder of the caller; refused where it cannot be written."""
    stem = Path(argument).name.partition("*")[0].rstrip("_-.") or "recording"
    return PAGE.convert(f"{stem.split('.')[0]}.report.html", None, None)


def _of_project(path: str, output: str, seed: int) -> dict[str, object]:
    """The page of the branch that ends at the current node."""
    project = Project.open(path).diagnose(seed=seed)
    diagnosis = project.diagnosis
    assert diagnosis is not None
    fits = [project.fit_of(node) for node in project.tree.path(project.current)]
    comparison = compare(fits, project.recording)
    account = of_project(project, diagnosis, comparison)
    write_account(account, output)
    return {"summary": account.summary, **diagnosis.to_dict()}


def _of_data(
    arguments: tuple[str, ...],
    specs: tuple[str, ...],
    reading: ReadOptions,
    output: str,
    *,
    starts: int,
    seed: int,
) -> dict[str, object]:
    """The page of a recording: its models compared, the best of them improved."""
    data, named = split(arguments)
    recording = read_recording(data, reading)
    fits: list[Fit] = []
    for name in (*named, *specs):
        say(f"fitting {name}")
        fits.append(model_fit(name, recording, starts=starts, seed=seed))
    best = min(fits, key=error_of).model if fits else "coulomb"
    improvement = improve(best, recording, starts=starts, seed=seed, progress=say)
    others = [f for f in fits if f.model.spec != improvement.base.model.spec]
    steps = [step.after for step in improvement.steps]
    shown = [*others, improvement.base, *steps[:-1], *([improvement.final] if steps else [])]
    comparison = compare(shown, recording)
    write_account(of_improvement(improvement, comparison), output)
    return {
        "summary": summary_sentence(improvement),
        "compare": comparison.to_dict(),
        "improve": improvement.to_dict(),
    }
