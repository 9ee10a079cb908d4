"""`stribeck fleet`: identify many robots, joints and days."""

from __future__ import annotations

from datetime import datetime

import click

from stribeck.base.pool import Stopped
from stribeck.cli.choices import choice_options
from stribeck.cli.common import (
    echo_result,
    json_option,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import split_one
from stribeck.cli.flags import with_flags
from stribeck.cli.outputs import FIGURE, PAGE, CheckedCommand
from stribeck.cli.progress import Progress, stop_with
from stribeck.cli.refused import OF_A_FLEET, refusing
from stribeck.cli.unread import refuse_unread
from stribeck.identify.stated.choices import Choices
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.fleet.changes import Question
from stribeck.scale.fleet.fleet import STRAGGLER
from stribeck.scale.fleet.fleet import fleet as run_fleet
from stribeck.scale.fleet.identified import IMPROVE
from stribeck.scale.fleet.result import Fleet


@click.command(cls=CheckedCommand)
@click.argument("files", nargs=-1, required=True, metavar="FILES... [MODEL]")
@click.option(
    "--model",
    default=None,
    metavar=f"SPEC|M.toml|{IMPROVE}",
    help=f"As MODEL: fitted to every joint; {IMPROVE}: improve from --base.  [default: {IMPROVE}]",
)
@click.option("--base", default="coulomb", show_default=True, help="Base model of improve.")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False),
    default="stribeck-fleet",
    show_default=True,
    help="Folder of the results; finished tasks in it are not repeated.",
)
@click.option(
    "--name",
    default=None,
    metavar="PATTERN",
    help='Pattern of the end of paths: "{robot}/{day}.parquet", also with {joint} and *. '
    "[default: the robot is the folder, the day the last date in the path]",
)
@click.option("--day", default=None, metavar="COLUMN", help="Column with the date.")
@click.option(
    "--since",
    type=click.DateTime(["%Y-%m-%d"]),
    default=None,
    help="First of the new days. [default: first of the newest --window days]",
)
@click.option(
    "--window",
    type=click.IntRange(min=1),
    default=7,
    show_default=True,
    metavar="DAYS",
    help="Number of newest days that are examined for changes.",
)
@click.option(
    "--history",
    type=click.IntRange(min=1),
    default=28,
    show_default=True,
    metavar="DAYS",
    help="Number of days before them for comparison.",
)
@click.option(
    "--false-discovery",
    type=click.FloatRange(0.0, 1.0, min_open=True),
    default=0.05,
    show_default=True,
    help="Largest expected share of false positives among the changed joints.",
)
@click.option(
    "--least-change",
    type=click.FloatRange(0.0),
    default=0.02,
    show_default=True,
    help="Smallest relative change that is reported.",
)
@click.option(
    "--scheduler",
    default=None,
    metavar="ADDRESS",
    help="Use the Dask cluster of this scheduler (pip install stribeck[fleet]).",
)
@click.option(
    "--workers",
    type=click.IntRange(min=1),
    default=None,
    help="Number of local processes. [default: one per core]",
)
@click.option(
    "--straggler",
    type=click.FloatRange(1.0, min_open=True),
    default=STRAGGLER,
    show_default=True,
    metavar="TIMES",
    help="Start a task a second time after this multiple of the median time.",
)
@click.option("--retry-failed", is_flag=True, help="Repeat failed tasks.")
@click.option("--plot", "picture", type=FIGURE, metavar="FILE", help="Write the figure (PNG).")
@click.option(
    "--report", type=PAGE, default=None, metavar="FILE", help="Write a self-contained page (HTML)."
)
@choice_options
@refusing(OF_A_FLEET)
@starts_option
@recording_options
@seed_option
@json_option
def fleet(
    files: tuple[str, ...],
    model: str | None,
    base: str,
    output: str,
    name: str | None,
    day: str | None,
    since: datetime | None,
    window: int,
    history: int,
    false_discovery: float,
    least_change: float,
    scheduler: str | None,
    workers: int | None,
    straggler: float,
    retry_failed: bool,
    picture: str | None,
    report: str | None,
    choices: Choices,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Identify every joint of FILES; find joints that changed or have an effect that others lack.

    FILES are recordings or quoted patterns ("logs/*/*.parquet"). The results are kept in the data
    set OUTPUT/results. Ctrl-C stops; the same command continues, and more files add to it. Files
    that cannot be used are reported and skipped; the exit code is 2 only if none can be used.
    """
    files, model = split_one(files, "--model", model, checked=False)
    _refuse_unread(model, since, scheduler)
    since_day = None if since is None else since.date()
    question = Question(since_day, window, history, false_discovery, least_change)
    with Progress("tasks") as bar:
        try:
            result = run_fleet(
                files,
                output,
                model or IMPROVE,
                base=base,
                name=name,
                day=day,
                starts=starts,
                seed=seed,
                question=question,
                workers=workers,
                scheduler=scheduler,
                straggler=straggler,
                retry_failed=retry_failed,
                progress=bar.show,
                note=lambda text: say(f"note: {text}"),
                **reading.given(),
                **choices.arguments(),
            )
        except (Stopped, KeyboardInterrupt):
            stop_with(bar, "the fleet", output)
    _write_pictures(result, picture, report)
    echo_result(result, as_json)


def _refuse_unread(model: str | None, since: datetime | None, scheduler: str | None) -> None:
    """Refuse options that have no effect beside others."""
    if model not in (None, IMPROVE):
        refuse_unread(f"with the model {model}", {"base": f"with --model {IMPROVE}"})
    if since is not None:
        refuse_unread("with --since", {"window": "without it"})
    if scheduler is not None:
        refuse_unread("with --scheduler", {"workers": "without it"})


def _write_pictures(result: Fleet, picture: str | None, report: str | None) -> None:
    if picture is not None:
        from stribeck.base.files import save_figure

        save_figure(result.plot(), picture)
        say(f"wrote {picture}")
    if report is not None:
        from stribeck.cli.pages import command_line, save_page
        from stribeck.report.pages.fleet import fleet_page

        save_page(fleet_page(result, command_line(), with_flags), report)
