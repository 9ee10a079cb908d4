"""`stribeck models`, `stribeck effects` and `stribeck inspect`."""

from __future__ import annotations

import click

from stribeck.cli.common import echo_json, json_option, recording_options, say, seed_option
from stribeck.cli.data import data_argument
from stribeck.cli.flags import with_flags
from stribeck.cli.outputs import CheckedCommand
from stribeck.diagnosis.inspect import inspect as inspect_file
from stribeck.diagnosis.inspect import write_proposed
from stribeck.models.catalog import catalog
from stribeck.recording.options import ReadOptions
from stribeck.report.catalog import catalog_text
from stribeck.report.inspection import inspection_text


@click.command(cls=CheckedCommand)
@seed_option
@json_option
def models(seed: int, as_json: bool) -> None:
    """List the friction laws: formula, source, parameters, and the effects that each contains."""
    rows = list(catalog()["laws"].values())
    if as_json:
        echo_json({"models": rows})
    else:
        click.echo(catalog_text(rows, "captures"))


@click.command(cls=CheckedCommand)
@seed_option
@json_option
def effects(seed: int, as_json: bool) -> None:
    """List the effects that can be missing, and the data that each needs."""
    rows = list(catalog()["effects"].values())
    if as_json:
        echo_json({"effects": rows})
    else:
        click.echo(catalog_text(rows, "needs"))


@click.command(cls=CheckedCommand)
@data_argument
@click.option(
    "--write-sidecar",
    is_flag=True,
    help="Write the proposed sidecar beside DATA, if there is none.",
)
@recording_options
@seed_option
@json_option
def inspect(
    data: tuple[str, ...], write_sidecar: bool, reading: ReadOptions, seed: int, as_json: bool
) -> None:
    """Show what DATA contains, whether its channels agree, and which effects it can show."""
    inspection = inspect_file(data, **reading.given())
    for note in inspection.notes:
        say(f"note: {note}")
    if write_sidecar:
        say(f"wrote {write_proposed(inspection, reading)}")
    if as_json:
        echo_json(inspection.to_dict(with_flags))
    else:
        click.echo(inspection_text(inspection, with_flags))
