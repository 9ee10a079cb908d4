"""`stribeck robot export`: an identified robot for controllers and simulators."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.base.errors import SpecError, joint_called, listed
from stribeck.cli.common import echo_result, json_option, say, seed_option
from stribeck.cli.outputs import DESCRIPTION, CheckedCommand
from stribeck.cli.unread import refuse_unread
from stribeck.exporters.robot.export import export_robot
from stribeck.robot.coupled import coupled
from stribeck.robot.describe import read_robot
from stribeck.robot.stored import read_friction
from stribeck.robot.updated_mjcf import write_mjcf
from stribeck.robot.updated_urdf import write_urdf

_WAYS = "give one of --to c DIR, --to rust DIR, --urdf FILE -o FILE and --mjcf FILE -o FILE"


@click.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@click.argument("folder", metavar="[DIR]", required=False, type=click.Path(file_okay=False))
@click.option(
    "--to",
    "language",
    metavar="FORMAT",
    default=None,
    help="Torques of all joints as a program. c: C99 without libraries; rust: a module for the "
    "crate.",
)
@click.option("--urdf", default=None, metavar="FILE", help="URDF of the robot, to be updated.")
@click.option("--mjcf", default=None, metavar="FILE", help="MJCF of the robot, to be updated.")
@click.option("-o", "--output", type=DESCRIPTION, default=None, help="URDF or MJCF to write.")
@click.option("--name", default=None, help="Prefix of files, types and functions of a program.")
@click.option(
    "--precision",
    default="f64",
    show_default=True,
    metavar="f64|f32",
    help="Number format of a program.",
)
@seed_option
@json_option
def export(
    described: str,
    folder: str | None,
    language: str | None,
    urdf: str | None,
    mjcf: str | None,
    output: str | None,
    name: str | None,
    precision: str,
    seed: int,
    as_json: bool,
) -> None:
    """Write ROBOT, a file of `robot fit -o`, for a controller or a simulator.

    As a program: gravity, inertia and friction of all joints for a planned motion, with test
    vectors and a self-test; exported code, crate and Python give the same bits. As URDF or MJCF:
    that of the robot with its inertia, damping and friction.
    """
    if sum(way is not None for way in (language, urdf, mjcf)) != 1:
        raise SpecError(_WAYS)
    if (language is None) != (folder is None) or (language is None) == (output is None):
        raise SpecError(_WAYS)
    robot, friction = read_robot(described), read_friction(described)
    if language is not None and folder is not None:
        written = export_robot(
            robot,
            friction,
            language,
            folder,
            name=name or Path(described).stem,
            precision=precision,
            seed=seed,
        )
        for joint, model in friction.items():
            if "delay" in model.effects:
                said = "the delay belongs to the recording: it is not exported"
                say(f"note: {joint_called(joint)}: {said}")
        echo_result(written, as_json)
        return
    assert output is not None
    refuse_unread("without --to", dict.fromkeys(("name", "precision"), "with it"))
    shared = [robot.names[k] for k in coupled(robot.coupling)]
    if shared:
        say(
            f"note: rotors and friction of joints {listed(shared)} are left out: the file has no "
            f"place for motors that turn with several joints"
        )
    if urdf is not None:
        write_urdf(output, urdf, robot, friction)
    elif mjcf is not None:
        write_mjcf(output, mjcf, robot, friction)
    say(f"wrote {output}")
