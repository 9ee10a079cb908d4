"""`stribeck reproduce`: the tables and figures of a paper, its numbers beside ours."""

from __future__ import annotations

import click

from stribeck.cli.common import echo_json, json_option, say, seed_option
from stribeck.cli.outputs import FOLDER, CheckedCommand


@click.command(cls=CheckedCommand)
@click.argument("paper")
@click.option(
    "-o",
    "--output",
    type=FOLDER,
    default=None,
    metavar="DIR",
    help="Folder of the page, the figures and the rows.",
)
@click.option("--quick", is_flag=True, help="Fewer rows and starts, in seconds.")
@seed_option
@json_option
def reproduce(paper: str, output: str | None, quick: bool, seed: int, as_json: bool) -> None:
    """Repeat a paper's tables and figures, and print its numbers beside ours.

    PAPER is gantry, ur5e_review, tadese, indri or bittencourt. Each number has a tolerance and its
    reason; numbers outside are listed as misses. Data that a paper does not publish are simulated
    from its printed parameters; the output says which.
    """
    from stribeck.benchmark.reproduce.page import write_reproduction
    from stribeck.benchmark.reproduce.papers import reproduce as repeat
    from stribeck.benchmark.reproduce.text import reproduction_text

    made = repeat(paper, seed=seed, quick=quick)
    figures = [] if output is None else write_reproduction(made, output)
    if output is not None:
        say(f"wrote {output}/{made.paper}.html, rows.csv, rows.json and {len(figures)} figures")
    if as_json:
        echo_json(made.to_dict(figures))
    else:
        click.echo(reproduction_text(made))
