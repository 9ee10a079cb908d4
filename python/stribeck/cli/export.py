"""`stribeck export`: a model as a program for a controller."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.cli.common import echo_result, is_model_file, json_option, say, seed_option
from stribeck.cli.outputs import CheckedCommand
from stribeck.exporters.export import export as write
from stribeck.exporters.mujoco import left_out
from stribeck.models.build import model as named
from stribeck.models.reader import read_model_file
from stribeck.passivity.operating_box import parse_sides


@click.command(cls=CheckedCommand)
@click.argument("model")
@click.option(
    "--to",
    "language",
    required=True,
    metavar="FORMAT",
    help="c: C99 without libraries; rust: a module for the crate; mujoco: Coulomb and viscous "
    "friction of a joint as MJCF; json: the step as data.",
)
@click.argument("folder", metavar="DIR", type=click.Path(file_okay=False))
@click.option("--name", default=None, help="Prefix of files, types and functions.")
@click.option(
    "--precision",
    default="f64",
    show_default=True,
    metavar="f64|f32|q31|q15",
    help="Number format; q31 and q15 are fixed point.",
)
@click.option("--libm", is_flag=True, help="In C, use math.h instead of own functions.")
@click.option(
    "--box",
    "sides",
    multiple=True,
    metavar="CHANNEL=LOW:HIGH",
    help="Operating box, as in velocity=-3.14:3.14. [default: that of the model file]",
)
@seed_option
@json_option
def export(
    model: str,
    language: str,
    folder: str,
    name: str | None,
    precision: str,
    libm: bool,
    sides: tuple[str, ...],
    seed: int,
    as_json: bool,
) -> None:
    """Write MODEL into DIR as a program for a controller, with test vectors and a self-test.

    Exported code, crate and Python give the same bits. A model file also provides the operating box
    and what the model was fitted on.
    """
    asked = read_model_file(model) if is_model_file(model) else named(model)
    called = name or (Path(model).stem if is_model_file(model) else None)
    written = write(
        asked,
        language,
        folder,
        name=called,
        precision=precision,
        libm=libm,
        box=parse_sides(sides),
        seed=seed,
    )
    if written.language == "mujoco" and (left := left_out(written.model)):
        say(f"note: MuJoCo has no such term, so it is left out: {', '.join(left)}")
    elif "delay" in written.model.effects:
        say("note: the delay belongs to the recording, not to the joint: it is not exported")
    echo_result(written, as_json)
