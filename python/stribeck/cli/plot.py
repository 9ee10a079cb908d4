"""`stribeck plot`: one figure of models on a recording."""

from __future__ import annotations

import click

from stribeck.base.errors import SpecError
from stribeck.cli.choices import per_run_option
from stribeck.cli.common import (
    echo_json,
    json_option,
    read_recording,
    recording_options,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of_both, split
from stribeck.cli.fitted import fits_of
from stribeck.cli.formulas import Written, formula_options
from stribeck.cli.outputs import FIGURE, CheckedCommand
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.plots.draw import FIGURES
from stribeck.report.plots.draw import plot as draw
from stribeck.report.plots.page import width_in_mm


@click.command(cls=CheckedCommand)
@arguments_of_both
@click.option(
    "--what",
    type=click.Choice([*FIGURES]),
    default="friction-velocity",
    show_default=True,
    help="The figure.",
)
@click.option(
    "-o", "--output", required=True, type=FIGURE, help="File to write: .png, .svg or .pdf."
)
@click.option(
    "--width",
    default="single",
    show_default=True,
    metavar="single|double|MM",
    help="Column width: 88 mm, 180 mm, or a number of mm.",
)
@formula_options
@per_run_option
@starts_option
@recording_options
@seed_option
@json_option
def plot(
    arguments: tuple[str, ...],
    what: str,
    output: str,
    width: str,
    written: Written,
    per_run: tuple[str, ...],
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Draw one figure of MODELS on DATA, in the column width of a journal.

    A spec is fitted to DATA first; model files and published sets are drawn as they are.
    """
    millimetres = width_in_mm(width)
    data, models = split(arguments)
    if not (models or written.laws):
        raise SpecError("no model is given: name laws or model files, or write laws by --law")
    recording = read_recording(data, reading)
    fits = fits_of(models, written, recording, starts=starts, seed=seed, per_run=per_run)
    draw(recording, fits, what, width=millimetres, path=output)
    if as_json:
        drawn = [fitted.model.spec for fitted in fits]
        echo_json({"what": what, "path": output, "models": drawn, "width_mm": millimetres})
    else:
        click.echo(f"wrote {output}: {what}, {millimetres:g} mm wide")
