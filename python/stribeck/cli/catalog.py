"""`stribeck models`, `stribeck effects` and `stribeck inspect`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import click

from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure
from stribeck.cli.common import echo_json, json_option, recording_options, say, seed_option
from stribeck.cli.data import data_argument
from stribeck.cli.flags import with_flags
from stribeck.cli.outputs import FIGURE, CheckedCommand
from stribeck.cli.words import complete_effect, complete_law
from stribeck.diagnosis.inspect import inspect as inspect_file
from stribeck.diagnosis.inspect import write_proposed
from stribeck.models.catalog import catalog, check_effect, effect_ids, law_row
from stribeck.models.spec import parse_spec
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.catalog import catalog_text, effect_text, law_text
from stribeck.report.inspection import inspection_text

_figure_option = click.option(
    "-o",
    "--output",
    type=FIGURE,
    default=None,
    metavar="FILE",
    help="Write the curve of ID as a figure (PNG, SVG, PDF).",
)


@click.command(cls=CheckedCommand)
@click.argument("id", required=False, shell_complete=complete_law)
@_figure_option
@seed_option
@json_option
def models(id: str | None, output: str | None, seed: int, as_json: bool) -> None:
    """List the friction laws: formula, source, parameters, and the effects that each contains.

    With ID, show one law with its curve.
    """
    if id is None:
        _list_all(output, as_json, "models", list(catalog()["laws"].values()), "captures")
        return
    if id in effect_ids():
        raise SpecError(f"{id!r} is an effect: `stribeck effects {id}` shows it")
    law, with_effects = parse_spec(id)
    row = law_row(law)
    if with_effects or row is None:
        raise SpecError(f"{id}: give one law of `stribeck models`, without effects")
    from stribeck.report.law_curve import law_curve

    curve = law_curve(law)
    if output is not None:
        from stribeck.report.plots.catalog import law_figure

        save_figure(law_figure(curve, f"{row['id']}: {row['title']}"), output)
        say(f"wrote {output}")
    if as_json:
        echo_json(row)
    else:
        click.echo(law_text(row, curve))


@click.command(cls=CheckedCommand)
@click.argument("id", required=False, shell_complete=complete_effect)
@_figure_option
@seed_option
@json_option
def effects(id: str | None, output: str | None, seed: int, as_json: bool) -> None:
    """List the effects that can be missing, and the data that each needs.

    With ID, show one effect with the residual of a model that lacks it.
    """
    if id is None:
        _list_all(output, as_json, "effects", list(catalog()["effects"].values()), "needs")
        return
    if law_row(id) is not None:
        raise SpecError(f"{id!r} is a law: `stribeck models {id}` shows it")
    row = catalog()["effects"][check_effect(id)]
    from stribeck.report.effect_example import effect_example

    example = effect_example(id)
    if output is not None:
        from stribeck.report.plots.catalog import effect_figure

        save_figure(effect_figure(example, f"{row['id']}: {row['title']}"), output)
        say(f"wrote {output}")
    if as_json:
        echo_json(row)
    else:
        click.echo(effect_text(row, example))


def _list_all(
    output: str | None,
    as_json: bool,
    name: str,
    rows: Sequence[Mapping[str, object]],
    last: str,
) -> None:
    """The whole catalog of laws or effects."""
    if output is not None:
        raise SpecError(
            f"-o draws one curve: name it, as in `stribeck {name} {rows[0]['id']} -o FILE`"
        )
    if as_json:
        echo_json({name: rows})
    else:
        click.echo(catalog_text(rows, last))
        click.echo(f"One of them with its curve: stribeck {name} {rows[0]['id']}")


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
