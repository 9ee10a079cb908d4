"""`stribeck project`: the loop driven by hand, with every branch kept in one file."""

from __future__ import annotations

import os

import click

from stribeck.base.errors import ProjectError
from stribeck.base.lock import one_writer
from stribeck.base.replaceable import check_folder
from stribeck.cli.choices import value_options
from stribeck.cli.common import (
    echo_json,
    echo_result,
    figures_option,
    json_option,
    least_fall_option,
    recording_options,
    report_option,
    save_findings,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import data_argument
from stribeck.cli.formulas import Written, candidate_option, check_candidates
from stribeck.cli.outputs import MODEL, CheckedCommand
from stribeck.cli.pages import diagnosis_report
from stribeck.cli.refused import OF_A_PROJECT, refusing
from stribeck.cli.unread import refuse_unread
from stribeck.identify.stated.choices import Choices
from stribeck.projects.project import Project
from stribeck.recording.stated.options import ReadOptions


@click.group()
def project() -> None:
    """Drive the loop by hand: add, reject, go back; a file keeps every branch.

    PROJECT is the file, NODE a number or a name of its tree.
    """


def _show(made: Project, as_json: bool) -> None:
    echo_result(made, as_json)


def _written(made: Project, as_json: bool) -> None:
    """Save a changed project and show it."""
    made.save()
    say(f"wrote {made.path}")
    _show(made, as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@data_argument
@click.option(
    "--base",
    default="coulomb",
    show_default=True,
    help="Spec, model file or formula to start from.",
)
@value_options
@refusing(OF_A_PROJECT)
@starts_option
@recording_options
@seed_option
@json_option
def new(
    path: str,
    data: tuple[str, ...],
    base: str,
    choices: Choices,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Make PROJECT of the recording DATA, with the base model fitted; several are its runs."""
    check_folder(path, ProjectError)
    with one_writer(path):
        if os.path.lexists(path):
            raise ProjectError(f"{path} is there already: give another name, or remove it first")
        model = Written().model(base)
        made = Project.new(
            path, data, model, starts=starts, seed=seed, choices=choices, **reading.given()
        )
        for note in made.recording.notes:
            say(f"note: {note}")
        _written(made, as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@json_option
def show(path: str, as_json: bool) -> None:
    """Show the tree with its errors, and the current node."""
    _show(Project.open(path), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@report_option
@figures_option
@candidate_option
@least_fall_option
@seed_option
@json_option
def diagnose(
    path: str,
    report: str | None,
    figures: str | None,
    candidates: tuple[str, ...],
    least_fall: float,
    seed: int,
    as_json: bool,
) -> None:
    """Find what is missing at the current node, and remember it.

    Effects that were rejected on the way to it are not tried.
    """
    check_candidates(candidates)
    with one_writer(path):
        made = Project.open(path)
        made = made.diagnose(least_fall=least_fall, candidates=candidates, seed=seed)
        made.save()
    say(f"wrote {made.path}")
    assert made.diagnosis is not None
    save_findings((*made.diagnosis.findings, *made.diagnosis.demoted), figures)
    diagnosis_report(made.diagnosis, report)
    if as_json:
        echo_json({"node": made.current, **made.diagnosis.to_dict()})
    else:
        click.echo(f"Node {made.current}. {made.diagnosis!r}")


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("effect")
@starts_option
@seed_option
@json_option
def add(path: str, effect: str, starts: int, seed: int, as_json: bool) -> None:
    """Add EFFECT to the current model. The result is a new, current node.

    EFFECT is an id or 'NAME = FORMULA'.
    """
    with one_writer(path):
        _written(Project.open(path).add(effect, starts=starts, seed=seed), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("effect")
@starts_option
@seed_option
@json_option
def drop(path: str, effect: str, starts: int, seed: int, as_json: bool) -> None:
    """Remove EFFECT from the current model. The result is a new, current node."""
    with one_writer(path):
        _written(Project.open(path).drop(effect, starts=starts, seed=seed), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("effect")
@click.option("--because", default="", metavar="TEXT", help="The reason; it is kept in the file.")
@click.option("--undo", is_flag=True, help="Undo the rejection.")
@json_option
def reject(path: str, effect: str, because: str, undo: bool, as_json: bool) -> None:
    """Exclude EFFECT at the current node and at all nodes below it."""
    if undo:
        refuse_unread("with --undo", {"because": "without it"})
    with one_writer(path):
        made = Project.open(path)
        _written(made.accept(effect) if undo else made.reject(effect, because), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("node", required=False)
@json_option
def back(path: str, node: str | None, as_json: bool) -> None:
    """Go back to NODE, or to the parent of the current node; no node is deleted."""
    with one_writer(path):
        _written(Project.open(path).back(node), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("name")
@json_option
def name(path: str, name: str, as_json: bool) -> None:
    """Name the branch that begins at the current node ('' removes the name)."""
    with one_writer(path):
        _written(Project.open(path).named(name), as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.option(
    "--max-steps",
    type=click.IntRange(min=0),
    default=8,
    show_default=True,
    help="Largest number of effects to add.",
)
@candidate_option
@least_fall_option
@seed_option
@json_option
def improve(
    path: str,
    max_steps: int,
    candidates: tuple[str, ...],
    least_fall: float,
    seed: int,
    as_json: bool,
) -> None:
    """Diagnose and add from the current node until the residual is noise; each step is a node.

    Every step is saved at once.
    """
    check_candidates(candidates)
    with one_writer(path):
        made = Project.open(path).improve(
            least_fall=least_fall,
            most_steps=max_steps,
            candidates=candidates,
            seed=seed,
            progress=say,
            each=Project.save,
        )
        _written(made, as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.argument("nodes", nargs=2, metavar="NODE NODE")
@seed_option
@json_option
def compare(path: str, nodes: tuple[str, str], seed: int, as_json: bool) -> None:
    """Compare two nodes: errors, where each fails, parameters."""
    sides = Project.open(path).compare(*nodes, seed=seed)
    echo_result(sides, as_json)


@project.command(cls=CheckedCommand)
@click.argument("path", metavar="PROJECT")
@click.option("-o", "--output", required=True, type=MODEL, help="Model file.")
@json_option
def save(path: str, output: str, as_json: bool) -> None:
    """Write the current model as a model file (TOML)."""
    made = Project.open(path)
    made.save_model(output)
    say(f"wrote {output}")
    if as_json:
        echo_json({"node": made.current, "model": made.node.kept.model.spec, "path": output})
