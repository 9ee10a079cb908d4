"""`stribeck check`: is a model passive over its operating box?"""

from __future__ import annotations

import sys

import click

from stribeck.cli.common import echo_result, is_model_file, json_option, seed_option
from stribeck.cli.outputs import CheckedCommand
from stribeck.models.build import model as named
from stribeck.models.reader import load
from stribeck.passivity.check import check as certify
from stribeck.passivity.operating_box import parse_sides


@click.command(cls=CheckedCommand)
@click.argument("model")
@click.option(
    "--box",
    "sides",
    multiple=True,
    metavar="CHANNEL=LOW:HIGH",
    help="Operating box, as in velocity=-3.14:3.14. [default: that of the model file]",
)
@seed_option
@json_option
def check(model: str, sides: tuple[str, ...], seed: int, as_json: bool) -> None:
    """Prove that MODEL is passive over its operating box, or show a motion that generates energy.

    Exit code 0: proved passive; 1: not proved. The check is deterministic.
    """
    asked = load(model) if is_model_file(model) else named(model)
    certificate = certify(asked, parse_sides(sides))
    echo_result(certificate, as_json)
    if not certificate.passive:
        sys.exit(1)
