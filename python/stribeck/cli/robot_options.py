"""Options and inputs that the commands of `stribeck robot` share."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.base.errors import SpecError
from stribeck.cli.common import (
    json_option,
    least_fall_option,
    recording_options,
    seed_option,
    starts_option,
)
from stribeck.cli.options import Command, Values, added, gathered
from stribeck.cli.outputs import ROBOT
from stribeck.cli.refused import OF_A_ROBOT, refusing
from stribeck.cli.robot_runs import passes_options
from stribeck.robot.arm import Robot
from stribeck.robot.describe import DESCRIPTIONS, read_robot
from stribeck.robot.drive_gains import KnownPayload
from stribeck.robot.fit import ORDINARY

output_option = click.option(
    "-o",
    "--output",
    type=ROBOT,
    default=None,
    help="Write the identified robot to this file (TOML).",
)
runs_argument = click.argument("runs", nargs=-1, required=True, metavar="RUNS... [SPEC]")
cutoff_option = click.option(
    "--cutoff",
    type=float,
    default=None,
    help="Low-pass on both sides of the torque balance [Hz]. [default: ten times the bandwidth of "
    "the motion]",
)
evaluate_option = click.option(
    "--evaluate",
    multiple=True,
    metavar="FILE",
    help="Score the result on this recording, on which nothing is chosen.",
)
joint_model_option = click.option(
    "--joint-model",
    multiple=True,
    metavar="JOINT=SPEC",
    help="Model of one joint, in place of --model.",
)
payload_option = click.option(
    "--payload", multiple=True, metavar="RUN", help="Run in which the last link carries a payload."
)


def known_payload_options(command: Command) -> Command:
    """Add `--payload-mass` and `--payload-centre`; the command receives `known_payload`."""
    options = (
        click.option(
            "--payload-mass",
            type=float,
            default=None,
            help="Known mass of the payload: the drive gains follow. [kg]",
        ),
        click.option(
            "--payload-centre",
            default=None,
            metavar="X,Y,Z",
            help="Its centre of mass in the frame of the last link. [m]  [default: 0,0,0]",
        ),
    )

    def build(values: Values) -> KnownPayload | None:
        mass, centre = values.pop("payload_mass"), values.pop("payload_centre")
        if mass is None:
            if centre is not None:
                raise SpecError("--payload-centre needs --payload-mass, the mass that is there")
            return None
        try:
            x, y, z = (float(part) for part in (centre or "0,0,0").split(","))
        except ValueError:
            raise SpecError(f"--payload-centre {centre}: write X,Y,Z, such as 0,0,0.05") from None
        return KnownPayload(mass, (x, y, z))

    return gathered(command, options, "known_payload", build)


def robot_options(command: Command) -> Command:
    """Add `--robot`, `--urdf` and `--mjcf`; the command receives the robot as `described`."""
    options = (
        click.option("--robot", "robot_file", default=None, metavar="FILE", help="Robot file."),
        click.option("--urdf", default=None, metavar="FILE", help="URDF of the robot."),
        click.option("--mjcf", default=None, metavar="FILE", help="MJCF of the robot."),
    )

    def build(values: Values) -> Robot:
        names = ("robot_file", "urdf", "mjcf")
        given = {name: path for name in names if (path := values.pop(name))}
        if len(given) != 1:
            raise SpecError(
                "one description of the robot is needed: --robot FILE, --urdf FILE or --mjcf FILE"
            )
        ((name, path),) = given.items()
        if name != "robot_file" and Path(path).suffix.lower() not in DESCRIPTIONS:
            raise SpecError(
                f"--{name} {path}: a description ends in .urdf or .xml: rename the file"
            )
        return read_robot(path)

    return gathered(command, options, "described", build)


def by_joint(given: tuple[str, ...]) -> dict[str, str]:
    """`JOINT=SPEC` texts as a mapping."""
    made = {}
    for text in given:
        name, equals, spec = text.partition("=")
        if not equals or not name or not spec:
            raise SpecError(f"--joint-model {text}: write JOINT=SPEC, such as 2=coulomb+load")
        made[name.strip()] = spec.strip()
    return made


def loop_options(command: Command) -> Command:
    """Add the options that `diagnose` and `improve` share."""
    return added(
        (
            runs_argument,
            robot_options,
            click.option(
                "--base",
                default=None,
                help=f"LAW[+effect...], the same as SPEC.  [default: {ORDINARY}]",
            ),
            refusing(OF_A_ROBOT),
            joint_model_option,
            payload_option,
            cutoff_option,
            least_fall_option,
            starts_option,
            recording_options,
            passes_options,
            seed_option,
            json_option,
        ),
        command,
    )
