"""`stribeck study`: fit many laws to every joint of a recording, from many starts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.base.pool import Stopped
from stribeck.cli.choices import choice_options
from stribeck.cli.common import (
    Result,
    echo_result,
    json_option,
    recording_options,
    report_option,
    say,
    seed_option,
    starts_option,
    workers_option,
)
from stribeck.cli.data import arguments_of, split
from stribeck.cli.evaluation import Judgement, WithJudgements, evaluate_option, judged
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.progress import Progress, stop_with
from stribeck.cli.refused import OF_A_STUDY, refusing
from stribeck.fitting.evaluate import evaluated, refuse_fitted_on
from stribeck.identify.stated.choices import Choices
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.study.plan import REVIEW
from stribeck.scale.study.result import Study
from stribeck.scale.study.study import study as make_study


@click.command(cls=CheckedCommand)
@arguments_of("DATA [SPEC...]")
@click.option(
    "--law",
    "laws",
    multiple=True,
    metavar="SPEC",
    help="A law to fit, as SPEC; may be repeated. [default: the 25 laws of the review]",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder of the study. [default: name of DATA with .study]",
)
@choice_options
@refusing(OF_A_STUDY)
@evaluate_option
@starts_option
@click.option(
    "--low-speed",
    type=float,
    default=None,
    help="Limit of low speed in the tables. [default: 0.1 rad/s, or 0.01 m/s]",
)
@workers_option
@report_option
@recording_options
@seed_option
@json_option
def study(
    arguments: tuple[str, ...],
    laws: tuple[str, ...],
    output: str | None,
    choices: Choices,
    evaluate: tuple[str, ...],
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
    data, laws = _data_and_laws(arguments, laws)
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
        from stribeck.report.pages.study import study_page

        save_page(study_page(result, command_line()), report)
    echo_result(_judged(result, evaluate, reading), as_json)


def _data_and_laws(
    arguments: tuple[str, ...], laws: tuple[str, ...]
) -> tuple[str, tuple[str, ...]]:
    """The recording, and the laws that are named beside it and by `--law`."""
    data, named = (arguments, ()) if len(arguments) == 1 else split(arguments)
    if len(data) != 1:
        raise SpecError(f"a study is of one file, {len(data)} are given: {', '.join(data)}")
    return data[0], (*named, *laws)


def _judged(result: Study, evaluate: tuple[str, ...], reading: ReadOptions) -> Result:
    """The study with the errors of its best fits on other recordings."""
    if not evaluate:
        return result
    judgements = []
    for joint in result.joints:
        recording = result.plan.read(joint)
        others = judged(evaluate, replace(reading, joint=joint))
        for other in others:
            refuse_fitted_on(other, recording.hashes)
        for _, row, of, entry in result.entries():
            if of == joint:
                model = entry.best.model(recording)
                said = {"joint": joint, "model": row.law}
                judgements += [
                    Judgement(said, model.torque_unit, evaluated(model, other)) for other in others
                ]
    return WithJudgements(result, judgements)
