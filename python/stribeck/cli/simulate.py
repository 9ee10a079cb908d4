"""`stribeck simulate`: simulate a joint with friction."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure, write_table
from stribeck.cli.common import (
    echo_result,
    json_option,
    say,
    seed_option,
)
from stribeck.cli.motion import (
    OF_A_TRAJECTORY,
    at_the_joint,
    check_joint,
    joint_of,
    joint_options,
    model_of,
    trajectory_of,
    trajectory_options,
    value_option,
)
from stribeck.cli.options import Values
from stribeck.cli.outputs import FIGURE, TABLE, CheckedCommand
from stribeck.cli.unread import refuse_unread
from stribeck.motion.generate.files import file_bytes
from stribeck.motion.simulate.acting import take_apart
from stribeck.motion.simulate.drive import Controller, Drive, Follow, Pull, Torque
from stribeck.motion.simulate.joint import Joint, Transmission
from stribeck.motion.simulate.run import simulate as move

#: Bandwidth of the closed loop of inertia and controller, Hz.
BANDWIDTH = 5.0
#: Options that only a controller on a trajectory reads.
CLOSED_LOOP = dict.fromkeys(
    (*OF_A_TRAJECTORY, "kp", "ki", "kd", "bandwidth", "limit", "feedforward"),
    "with a controller on a trajectory",
)
#: Default duration of a push or pull, s.
SECONDS = 10.0


@click.command(cls=CheckedCommand)
@click.argument("model")
@value_option
@joint_options
@click.option(
    "--motor-inertia",
    type=float,
    help="Inertia of a motor that is separate from its load, kg m2 or kg.",
)
@click.option(
    "--transmission", type=float, help="Stiffness between motor and load, N m/rad or N/m."
)
@click.option(
    "--transmission-damping", type=float, default=0.0, help="Damping between motor and load."
)
@click.option(
    "--backlash", type=float, default=0.0, help="Backlash between motor and load, rad or m."
)
@trajectory_options
@click.option("--kp", type=float, help="Proportional gain of the controller.")
@click.option("--ki", type=float, default=0.0, help="Integral gain.")
@click.option("--kd", type=float, help="Derivative gain.")
@click.option(
    "--bandwidth",
    type=float,
    default=BANDWIDTH,
    show_default=True,
    help="Bandwidth of the closed loop if no gains are given, Hz.",
)
@click.option(
    "--limit",
    type=float,
    default=math.inf,
    help="Largest motor torque, N m or N; with --pitch in N m before the screw.",
)
@click.option(
    "--feedforward",
    is_flag=True,
    help="Add the torque of inertia and gravity of the desired motion.",
)
@click.option(
    "--torque",
    type=float,
    help="Open loop: constant motor torque, N m or N; with --pitch in N m before the screw.",
)
@click.option("--spring", type=float, help="Open loop: stiffness of a spring that pulls the joint.")
@click.option("--pull-speed", type=float, help="Speed of the far end of the spring.")
@click.option("--seconds", type=float, help="Duration, s. [default: there and back, or 10]")
@click.option("--step", type=float, default=1e-3, show_default=True, help="Time step, s.")
@click.option("--position", type=float, help="Position at the start, rad or m.")
@click.option(
    "--temperature", type=float, help="Temperature, degC. [default: middle of the model's box]"
)
@click.option(
    "-o",
    "--output",
    type=TABLE,
    help="Write the motion as a recording (.csv or .parquet), and its sidecar.",
)
@click.option(
    "--plot",
    "picture",
    type=FIGURE,
    metavar="FILE",
    help="Write a figure of the motion (PNG, SVG, PDF).",
)
@seed_option
@json_option
def simulate(
    model: str,
    values: tuple[str, ...],
    step: float,
    seconds: float | None,
    position: float | None,
    temperature: float | None,
    output: str | None,
    picture: str | None,
    seed: int,
    as_json: bool,
    **sizes: Any,
) -> None:
    """Simulate a joint with the friction of MODEL: in closed loop, pushed, or pulled by a spring.

    Without --inertia or --mass, the rigid body is the one that was identified with the friction.
    """
    asked = model_of(model, values)
    joint = _with_transmission(joint_of(sizes), sizes)
    check_joint(model, asked, joint)
    drive = _drive(sizes, take_apart(asked, joint).joint, seed)
    if seconds is None and not isinstance(drive, Follow):
        seconds = SECONDS
    simulation = move(
        asked,
        joint,
        drive,
        seconds=seconds,
        step=step,
        position=position,
        temperature=temperature,
    )
    if output is not None:
        write_table(
            output,
            file_bytes(simulation.to_frame(), Path(output).suffix.lower()),
            f'kind = "recording"\njoint_kind = "{simulation.joint.kind}"\n',
        )
        say(f"wrote {output}")
    if picture is not None:
        save_figure(simulation.plot(), picture)
        say(f"wrote {picture}")
    echo_result(simulation, as_json)


def _with_transmission(joint: Joint | None, sizes: Values) -> Joint | None:
    """The joint with a separate motor, if the options describe one."""
    motor, stiffness = sizes["motor_inertia"], sizes["transmission"]
    if motor is None and stiffness is None:
        if sizes["backlash"] or sizes["transmission_damping"]:
            raise SpecError("--backlash and --transmission-damping need --transmission")
        return joint
    if motor is None or stiffness is None or joint is None:
        raise SpecError(
            "a separate motor needs --motor-inertia, --transmission, and --inertia or --mass of "
            "the load"
        )
    apart = Transmission(motor, stiffness, sizes["transmission_damping"], sizes["backlash"])
    return replace(joint, transmission=apart)


def _drive(sizes: Values, joint: Joint, seed: int) -> Drive:
    """The drive of the joint."""
    torque, spring, speed = sizes["torque"], sizes["spring"], sizes["pull_speed"]
    if torque is not None and spring is not None:
        raise SpecError("--torque and --spring exclude each other: give one of them")
    if torque is not None:
        refuse_unread("with --torque", {**CLOSED_LOOP, "pull_speed": "with --spring"})
        return Torque(torque * at_the_joint(sizes))
    if spring is not None:
        refuse_unread("with --spring", CLOSED_LOOP)
        if speed is None:
            raise SpecError("--spring needs --pull-speed, the speed of its far end")
        return Pull(spring, speed)
    if speed is not None:
        raise SpecError("--pull-speed needs --spring, the stiffness")
    path = trajectory_of(sizes, joint, seed)
    return Follow(path, _controller(sizes, joint), sizes["feedforward"])


def _controller(sizes: Values, joint: Joint) -> Controller:
    """The given gains; the others place both poles of the joint at the bandwidth."""
    if not sizes["bandwidth"] > 0.0:
        raise SpecError(f"--bandwidth {sizes['bandwidth']:g}: give a positive number, in Hz")
    frequency = math.tau * sizes["bandwidth"]
    kp, kd = sizes["kp"], sizes["kd"]
    if kp is not None and kd is not None:
        refuse_unread("with --kp and --kd", {"bandwidth": "without one of them"})
    return Controller(
        proportional=joint.total_inertia * frequency**2 if kp is None else kp,
        derivative=2.0 * joint.total_inertia * frequency if kd is None else kd,
        integral=sizes["ki"],
        limit=sizes["limit"] * at_the_joint(sizes),
    )
