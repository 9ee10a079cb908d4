"""`stribeck robot simulate` and `plan`: motions of a robot, and recordings of them."""

from __future__ import annotations

from pathlib import Path

import click
import polars as pl

from stribeck.base.errors import RecordingError, SpecError
from stribeck.base.files import write_table
from stribeck.cli.common import echo_json, echo_result, json_option, say, seed_option
from stribeck.cli.outputs import TABLE, CheckedCommand
from stribeck.cli.plan import position_range
from stribeck.cli.unread import refuse_unread
from stribeck.motion.design.motion import Limits
from stribeck.motion.generate.files import file_bytes
from stribeck.robot.describe import read_robot
from stribeck.robot.follow import follow_robot
from stribeck.robot.plan import plan_robot
from stribeck.robot.simulate import simulate_robot
from stribeck.robot.stored import read_friction


@click.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@click.option("--seconds", type=float, default=30.0, show_default=True, help="Duration [s].")
@click.option(
    "--rate",
    type=float,
    default=None,
    help="Samples per second; in closed loop steps. [default: 200; with --compensate 1000]",
)
@click.option("--speed", type=float, default=1.0, show_default=True, help="RMS speed of a joint.")
@click.option(
    "--noise", type=float, default=0.01, show_default=True, help="Noise as a share of the torque."
)
@click.option(
    "--compensate",
    multiple=True,
    metavar="FILE",
    help="Follow the motion in closed loop, without compensation and with the friction of this "
    "robot file; may be repeated.",
)
@click.option(
    "--bandwidth", type=float, default=20.0, show_default=True, help="Of the closed loop [rad/s]."
)
@click.option("-o", "--output", type=TABLE, default=None, help="Recording to write.")
@seed_option
@json_option
def simulate(
    described: str,
    seconds: float,
    rate: float | None,
    speed: float,
    noise: float,
    compensate: tuple[str, ...],
    bandwidth: float,
    output: str | None,
    seed: int,
    as_json: bool,
) -> None:
    """Make a recording of ROBOT, as written by `stribeck robot fit -o`, on a Fourier motion.

    With --compensate ROBOT follows it in closed loop, with stiction in every joint, and the errors
    of the joints are printed; the recording is then of the last compensation, without noise.
    """
    arm, friction = read_robot(described), read_friction(described)
    if compensate:
        refuse_unread("with --compensate", {"noise": "without it"})
        tracked = follow_robot(
            arm,
            friction,
            {Path(path).stem: read_friction(path) for path in compensate},
            seconds=seconds,
            rate=1000.0 if rate is None else rate,
            speed=speed,
            bandwidth=bandwidth,
            seed=seed,
        )
        if output is not None:
            _write(tracked.to_frame(), output)
        echo_result(tracked, as_json)
        return
    refuse_unread("without --compensate", {"bandwidth": "with it"})
    if output is None:
        raise SpecError("nothing would be kept: give the recording to write, -o FILE")
    usual = 200.0 if rate is None else rate
    made = simulate_robot(
        arm, friction, seconds=seconds, rate=usual, speed=speed, noise=noise, seed=seed
    )
    _write(made, output)
    if as_json:
        echo_json(
            {
                "path": output,
                "joints": list(arm.names),
                "rows": made.height,
                "seconds": seconds,
                "rate_hz": usual,
                "noise": noise,
                "seed": seed,
            }
        )


def _write(made: pl.DataFrame, output: str) -> None:
    """Write a recording."""
    content = file_bytes(made, Path(output).suffix.lower())
    write_table(output, content, 'kind = "recording"\n', RecordingError)
    say(f"wrote {output}")


@click.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@click.option(
    "--position", default="-1.5:1.5", show_default=True, help="LOW:HIGH of each joint [rad, m]."
)
@click.option("--speed", type=float, default=1.5, show_default=True, help="Largest speed.")
@click.option(
    "--acceleration", type=float, default=5.0, show_default=True, help="Largest acceleration."
)
@click.option("--seconds", type=float, default=20.0, show_default=True, help="Duration [s].")
@click.option("--rate", type=float, default=200.0, show_default=True, help="Samples per second.")
@click.option("-o", "--output", type=TABLE, default=None, help="Write the motion (CSV, Parquet).")
@seed_option
@json_option
def plan(
    described: str,
    position: str,
    speed: float,
    acceleration: float,
    seconds: float,
    rate: float,
    output: str | None,
    seed: int,
    as_json: bool,
) -> None:
    """Plan a motion of all joints of ROBOT that shows base parameters and friction well.

    A robot file may state `torque_limit` of a joint, and spheres of its links that must not meet.
    """
    low, high = position_range(position)
    limits = Limits(low, high, speed, acceleration)
    made = plan_robot(read_robot(described), limits, seconds=seconds, rate=rate, seed=seed)
    if output is not None:
        _write(made.to_frame(), output)
    echo_result(made, as_json)
