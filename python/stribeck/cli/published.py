"""`stribeck published`: the parameter sets printed in the literature."""

from __future__ import annotations

import click

from stribeck.cli.common import echo_json, json_option, seed_option
from stribeck.cli.outputs import CheckedCommand
from stribeck.models.published.sets import PREFIX, every_set, published_set
from stribeck.report.published import set_text, sets_text


@click.command(cls=CheckedCommand)
@click.argument("id", required=False)
@seed_option
@json_option
def published(id: str | None, seed: int, as_json: bool) -> None:
    """List the parameter sets printed in the literature, or show one.

    ID may be the beginning of several ids. published:ID is accepted wherever a model file is.
    """
    start = (id or "").removeprefix(PREFIX)
    found = [one for one in every_set().values() if one.id.startswith(f"{start.rstrip('/')}/")]
    if id is None:
        found = list(every_set().values())
    if found:
        if as_json:
            echo_json({"published": [one.to_dict() for one in found]})
        else:
            click.echo(sets_text(found))
        return
    one = published_set(start)
    if as_json:
        echo_json(one.to_dict())
    else:
        click.echo(set_text(one))
