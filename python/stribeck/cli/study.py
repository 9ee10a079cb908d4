"""`stribeck study`: fit many laws to every joint of a recording, from many starts."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.base.pool import Stopped
from stribeck.cli.choices import choice_options
from stribeck.cli.common import (
    echo_result,
    json_option,
    recording_options,
    report_option,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.progress import Progress, stop_with
from stribeck.identify.choices import Choices
from stribeck.recording.options import ReadOptions
from stribeck.scale.study.plan import REVIEW
from stribeck.scale.study.study import study as make_study


@click.command(cls=CheckedCommand)
@click.argument("data")
@click.option(
    "--law",
    "laws",
    multiple=True,
    metavar="SPEC",
    help="A law to fit; may be repeated. [default: the 25 laws of the review]",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder of the study. [default: name of DATA with .study]",
)
@choice_options
@starts_option
@click.option(
    "--low-speed",
    type=float,
    default=None,
    help="Limit of low speed in the tables. [default: 0.1 rad/s, or 0.01 m/s]",
)
@click.option(
    "--workers",
    type=click.IntRange(min=1),
    default=None,
    help="Number of processes. [default: one per core]",
)
@report_option
@recording_options
@seed_option
@json_option
def study(
    data: str,
    laws: tuple[str, ...],
    output: str | None,
    choices: Choices,
    starts: int,
    low_speed: float | None,
    workers: int | None,
    report: str | None,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Fit many laws to every joint of DATA and compare them, as the UR5e review does.

    Every fit is saved at once. Ctrl-C stops; the same command continues.
    """
    folder = output if output is not None else f"{Path(data).stem}.study"
    with Progress() as bar:
        try:
            result = make_study(
                data,
                folder,
                laws or REVIEW,
                starts=starts,
                seed=seed,
                low_speed=low_speed,
                workers=workers,
                progress=bar.show,
                note=lambda text: say(f"note: {text}"),
                **reading.given(),
                **choices.arguments(),
            )
        except (Stopped, KeyboardInterrupt):
            stop_with(bar, "the study", folder)
    if report is not None:
        # Bokeh is slow to import.
        from stribeck.cli.pages import command_line, save_page
        from stribeck.report.study_page import study_page

        save_page(study_page(result, command_line()), report)
    echo_result(result, as_json)
