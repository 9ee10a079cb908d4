"""`stribeck benchmark`: how often the diagnosis is right, on recordings with a known truth."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from stribeck.base.pool import Stopped
from stribeck.cli.common import echo_json, json_option, say, seed_option, workers_option
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.progress import Progress


@click.group()
def benchmark() -> None:
    """Measure the reliability of the program on recordings with a known truth."""


@benchmark.command(cls=CheckedCommand)
@click.option(
    "--seeds",
    type=click.IntRange(min=1),
    default=10,
    show_default=True,
    help="Recordings of each kind; 10 is the full benchmark and takes hours.",
)
@click.option(
    "--generator",
    "generators",
    multiple=True,
    metavar="NAME",
    help="open_loop or closed_loop; may be repeated. [default: both]",
)
@click.option(
    "--only",
    default=None,
    metavar="WORD",
    help="Only cases with this group, effect, or part of the name.",
)
@click.option(
    "--realism",
    type=click.IntRange(0, 3),
    default=0,
    show_default=True,
    help="Nuisances in each recording: filters, lags, vibration, jitter, warm-up, wrong scales.",
)
@click.option(
    "--nuisance",
    default=None,
    metavar="NAME",
    help="One that every recording has, such as structural_mode.",
)
@click.option(
    "--sealed",
    is_flag=True,
    help="Nuisances on which the diagnosis was not developed.",
)
@click.option(
    "--without",
    multiple=True,
    metavar="CHANNEL",
    help="velocity or acceleration: not recorded; may be repeated.",
)
@click.option("--quick", is_flag=True, help="One recording of most kinds; takes minutes.")
@workers_option
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder of the answers, the confusion matrix and the figures.",
)
@seed_option
@json_option
def diagnosis(
    seeds: int,
    generators: tuple[str, ...],
    only: str | None,
    realism: int,
    nuisance: str | None,
    sealed: bool,
    without: tuple[str, ...],
    quick: bool,
    workers: int | None,
    output: str | None,
    seed: int,
    as_json: bool,
) -> None:
    """Hide effects in simulated recordings, diagnose them, and count the right answers.

    With --output every answer is saved at once: Ctrl-C stops, and the same command continues.
    """
    from stribeck.benchmark.cases import cases
    from stribeck.benchmark.generators import GENERATORS
    from stribeck.benchmark.run import run
    from stribeck.benchmark.text import score_text

    chosen = cases(
        seeds,
        generators=generators or tuple(GENERATORS),
        only=only,
        quick=quick,
        seed=seed,
        realism=realism,
        nuisance=nuisance,
        sealed=sealed,
        without=without,
    )
    folder = None if output is None else Path(output)
    with Progress("cases") as bar:
        try:
            answers, score = run(chosen, folder, workers=workers, progress=bar.show)
        except (Stopped, KeyboardInterrupt):
            bar.close()
            kept = (
                f"the finished part is in {folder}, and the same command continues it"
                if folder is not None
                else "nothing was saved: --output FOLDER saves every answer"
            )
            say(f"stribeck: stopped after {bar.done or 'no'} of {len(chosen)} cases; {kept}")
            sys.exit(130)
    if as_json:
        echo_json({"cases": len(answers), "seeds": seeds, **score.to_dict()})
    else:
        click.echo(score_text(score))


@benchmark.command(cls=CheckedCommand)
@click.option(
    "--seeds",
    type=click.IntRange(min=1),
    default=10,
    show_default=True,
    help="Arms with each effect or cause.",
)
@click.option(
    "--share",
    type=click.FloatRange(0.0, 1.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Share of these arms that is run, drawn by --seed; at least one of each kind.",
)
@click.option(
    "--only",
    default=None,
    metavar="WORD",
    help="Only arms of this group (effect, rigid, none, coverage), or with this hidden.",
)
@workers_option
@seed_option
@json_option
def robot(
    seeds: int, share: float, only: str | None, workers: int | None, seed: int, as_json: bool
) -> None:
    """Hide effects in one joint of simulated six-joint arms, and causes in their rigid bodies.

    Counts the right answers, and the 95 % intervals of identified arms that hold the truth.
    """
    from stribeck.benchmark.arms.cases import arm_cases
    from stribeck.benchmark.arms.score import run_arms
    from stribeck.benchmark.arms.text import arm_score_text

    chosen = arm_cases(seeds, share=share, only=only, seed=seed)
    with Progress("arms") as bar:
        try:
            answers, score = run_arms(chosen, workers=workers, progress=bar.show)
        except (Stopped, KeyboardInterrupt):
            bar.close()
            say(f"stribeck: stopped after {bar.done or 'no'} of {len(chosen)} arms")
            sys.exit(130)
    if as_json:
        rows = [answer.to_dict() for answer in answers]
        echo_json({"seeds": seeds, "share": share, **score.to_dict(), "answers": rows})
    else:
        click.echo(arm_score_text(score))
