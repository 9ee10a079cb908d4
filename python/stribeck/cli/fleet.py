"""`stribeck fleet`: the same work on many robots, joints and days."""

from __future__ import annotations

import sys
from datetime import datetime
from pathlib import Path

import click

from stribeck.base.pool import Stopped
from stribeck.cli.common import (
    check_output,
    echo_json,
    json_option,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.progress import Progress
from stribeck.recording.options import ReadOptions
from stribeck.scale.fleet.changes import Question
from stribeck.scale.fleet.fleet import STRAGGLER
from stribeck.scale.fleet.fleet import fleet as run_fleet
from stribeck.scale.fleet.identified import IMPROVE
from stribeck.scale.fleet.result import Fleet


@click.command()
@click.argument("files", nargs=-1, required=True, metavar=f"FILES... [{IMPROVE}]")
@click.option(
    "--model", default=None, metavar=f"SPEC|M.toml|{IMPROVE}",
    help=f"What is fitted to every joint; {IMPROVE}: find what is missing from --base.  "
    f"[default: {IMPROVE}]",
)  # fmt: skip
@click.option("--base", default="coulomb", show_default=True, help="Where improve begins.")
@click.option(
    "-o", "--output", type=click.Path(file_okay=False), default="stribeck-fleet",
    show_default=True, help="Folder of the data set; what it holds already is not done again.",
)  # fmt: skip
@click.option(
    "--name", default=None, metavar="PATTERN",
    help='How paths end: "{robot}/{day}.parquet", with {joint} and * too. [default: the robot is '
    "the folder, the day the last date in the path]",
)  # fmt: skip
@click.option("--day", default=None, metavar="COLUMN", help="Column that holds the date.")
@click.option(
    "--since", type=click.DateTime(["%Y-%m-%d"]), default=None,
    help="First of the new days. [default: the newest --window days]",
)  # fmt: skip
@click.option(
    "--window", type=click.IntRange(min=1), default=7, show_default=True, metavar="DAYS",
    help="How many of the newest days are looked at for changes.",
)  # fmt: skip
@click.option(
    "--history", type=click.IntRange(min=1), default=28, show_default=True, metavar="DAYS",
    help="How many days before them they are compared with.",
)  # fmt: skip
@click.option(
    "--false-discovery", type=click.FloatRange(0.0, 1.0, min_open=True), default=0.05,
    show_default=True, help="Largest share of the changed joints that may be there by chance.",
)  # fmt: skip
@click.option(
    "--least-change", type=click.FloatRange(0.0), default=0.02, show_default=True,
    help="Smallest relative change that counts.",
)  # fmt: skip
@click.option(
    "--scheduler", default=None, metavar="ADDRESS",
    help="Work on the Dask cluster of this scheduler (pip install stribeck[fleet]).",
)  # fmt: skip
@click.option(
    "--workers", type=click.IntRange(min=1), default=None,
    help="Processes of this machine. [default: one for each core]",
)  # fmt: skip
@click.option(
    "--straggler", type=click.FloatRange(1.0, min_open=True), default=STRAGGLER,
    show_default=True, metavar="TIMES",
    help="Hand a task out again that takes so many times the median.",
)  # fmt: skip
@click.option("--retry-failed", is_flag=True, help="Do again what failed before.")
@click.option("--plot", "picture", default=None, metavar="FILE", help="Write the picture (PNG).")
@click.option("--report", default=None, metavar="FILE", help="Write a self-contained page (HTML).")
@starts_option
@recording_options
@seed_option
@json_option
def fleet(
    files: tuple[str, ...], model: str | None, base: str, output: str, name: str | None,
    day: str | None, since: datetime | None, window: int, history: int,
    false_discovery: float, least_change: float, scheduler: str | None, workers: int | None,
    straggler: float, retry_failed: bool, picture: str | None, report: str | None, starts: int,
    reading: ReadOptions, seed: int, as_json: bool,
) -> None:  # fmt: skip
    """Identify every joint of FILES: which have changed, which have an effect the others lack.

    FILES are recordings or quoted patterns ("logs/*/*.parquet"), one or more joints in each. All
    results land in the Parquet data set OUTPUT/results. Ctrl-C stops; the same command goes on,
    and more files add to it. A file that cannot be used is reported and skipped; the exit code is
    2 only where none could.
    """
    for path in (picture, report):
        check_output(path)
    if model is None and files[-1] == IMPROVE and not Path(IMPROVE).exists():
        files = files[:-1]
    first = None if since is None else since.date()
    with Progress("tasks") as bar:
        try:
            result = run_fleet(
                files, output, model or IMPROVE, base=base, name=name, day=day, starts=starts,
                seed=seed, question=Question(first, window, history, false_discovery, least_change),
                workers=workers, scheduler=scheduler, straggler=straggler,
                retry_failed=retry_failed, progress=bar.show,
                note=lambda text: say(f"note: {text}"), **reading.given(),
            )  # fmt: skip
        except (Stopped, KeyboardInterrupt):
            bar.close()
            say(
                f"stribeck: stopped after {bar.done or 'no'} tasks of {bar.total or 'the fleet'}; "
                f"what is done is in {output}, and the same command goes on from there"
            )
            sys.exit(130)
    _write_pictures(result, picture, report)
    if as_json:
        echo_json(result.to_dict())
    else:
        click.echo(repr(result))


def _write_pictures(result: Fleet, picture: str | None, report: str | None) -> None:
    if picture is not None:
        from stribeck.base.files import save_figure

        save_figure(result.plot(), picture)
        say(f"wrote {picture}")
    if report is not None:
        from stribeck.cli.common import save_page
        from stribeck.report.fleet_page import fleet_page

        save_page(fleet_page(result), report)
