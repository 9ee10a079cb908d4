"""`stribeck last`: the last result again."""

from __future__ import annotations

import click

from stribeck.base.errors import ModelFileError, StribeckError
from stribeck.base.files import write_whole
from stribeck.cli.common import echo_json, json_option, say, seed_option
from stribeck.cli.kept import kept
from stribeck.cli.outputs import MODEL, CheckedCommand


@click.command(cls=CheckedCommand)
@click.option(
    "-o",
    "--output",
    type=MODEL,
    default=None,
    metavar="M.toml",
    help="Write the model of the last result to this file (TOML), and print nothing else.",
)
@seed_option
@json_option
def last(output: str | None, seed: int, as_json: bool) -> None:
    """Print the last result again, or write the model that was not saved.

    STRIBECK_LAST=off keeps no results.
    """
    found = kept()
    say(f"note: of {found.time} in {found.folder}: {found.command}")
    if output is not None:
        if found.model is None:
            raise StribeckError(
                f"the last result has no single model to write: {found.command or 'a command'}"
            )
        write_whole(output, found.model, ModelFileError)
        say(f"wrote {output}")
        if as_json:
            echo_json({"path": output, "command": found.command})
    elif found.json is not None and (as_json or found.text is None):
        echo_json(found.json)
    elif found.text is None or as_json:
        raise StribeckError("the JSON of the last result was too large to be kept: run it again")
    else:
        click.echo(found.text)
