"""`stribeck robot`: whole robots."""

from __future__ import annotations

from pathlib import Path

import click
import polars as pl

from stribeck.base.errors import RecordingError, SpecError
from stribeck.base.files import write_table
from stribeck.cli.common import (
    echo_json,
    echo_result,
    json_option,
    recording_options,
    report_option,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import split, split_one
from stribeck.cli.outputs import TABLE, CheckedCommand
from stribeck.cli.plan import position_range
from stribeck.cli.refused import OF_A_DIAGNOSIS, OF_A_ROBOT, refusing
from stribeck.cli.robot_export import export
from stribeck.cli.robot_options import (
    by_joint,
    cutoff_option,
    evaluate_option,
    joint_model_option,
    loop_options,
    output_option,
    payload_option,
    read_runs,
    robot_options,
    runs_argument,
)
from stribeck.cli.robot_page import robot_report
from stribeck.motion.design.motion import Limits
from stribeck.motion.generate.files import file_bytes
from stribeck.recording.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.compare import compare_robots
from stribeck.robot.describe import read_robot
from stribeck.robot.diagnosis import RobotDiagnosis
from stribeck.robot.fit import ORDINARY, fit_robot
from stribeck.robot.follow import follow_robot
from stribeck.robot.improve import MOST_STEPS, improve_robot
from stribeck.robot.plan import plan_robot
from stribeck.robot.result import RobotFit
from stribeck.robot.simulate import simulate_robot
from stribeck.robot.stored import read_friction, robot_toml, write_robot


@click.group()
def robot() -> None:
    """Identify the rigid bodies of a robot and the friction of all its joints.

    RUNS are recordings of all joints; several are runs of one robot.
    """


@robot.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@json_option
def show(described: str, as_json: bool) -> None:
    """Show the joints of ROBOT (a robot file, URDF or MJCF), and what torques can show of it."""
    found = read_robot(described)
    if not as_json:
        click.echo(repr(found))
        return
    base = BaseParameters.of(found)
    joints = [
        {
            "joint": joint.name,
            "kind": joint.movement,
            "parent": None if joint.parent is None else found.names[joint.parent],
            "drive_gain": joint.drive_gain,
            "mass": None if joint.inertial is None else float(joint.inertial[0]),
        }
        for joint in found.joints
    ]
    combinations = [
        {"combination": text, "unit": unit}
        for text, unit in zip(base.texts, base.units, strict=True)
    ]
    echo_json(
        {
            "robot": found.name,
            "joints": joints,
            "gravity": list(found.gravity),
            "base_parameters": combinations,
            "not_identifiable": list(base.not_shown),
        }
    )


@robot.command(cls=CheckedCommand)
@runs_argument
@robot_options
@click.option(
    "--model",
    "spec",
    default=None,
    help=f"LAW[+effect...], the same as SPEC.  [default: {ORDINARY}]",
)
@refusing(OF_A_ROBOT)
@joint_model_option
@payload_option
@evaluate_option
@cutoff_option
@starts_option
@recording_options
@seed_option
@output_option
@report_option
@json_option
def fit(
    runs: tuple[str, ...],
    described: Robot,
    spec: str | None,
    joint_model: tuple[str, ...],
    payload: tuple[str, ...],
    evaluate: tuple[str, ...],
    cutoff: float | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    output: str | None,
    report: str | None,
    as_json: bool,
) -> None:
    """Identify base parameters of the rigid bodies and the friction of every joint."""
    runs, spec = split_one(runs, "--model", spec)
    motion = read_runs(described, runs, reading, cutoff)
    others = [read_runs(described, (path,), reading, motion.cutoff) for path in evaluate]
    found = fit_robot(
        motion,
        spec or ORDINARY,
        of_joints=by_joint(joint_model),
        payload=payload,
        evaluate=others,
        starts=starts,
        seed=seed,
    )
    _save(found, output)
    robot_report(found, report)
    echo_result(found, as_json, lambda: robot_toml(found))


def _save(found: RobotFit, output: str | None) -> None:
    if output is not None:
        write_robot(found, output)
        say(f"wrote {output}")


@robot.command(cls=CheckedCommand)
@click.argument("arguments", nargs=-1, required=True, metavar="RUNS... SPEC...")
@robot_options
@refusing(OF_A_ROBOT)
@payload_option
@evaluate_option
@cutoff_option
@starts_option
@recording_options
@seed_option
@report_option
@json_option
def compare(
    arguments: tuple[str, ...],
    described: Robot,
    payload: tuple[str, ...],
    evaluate: tuple[str, ...],
    cutoff: float | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    report: str | None,
    as_json: bool,
) -> None:
    """Compare laws, each on all joints, with RUNS."""
    runs, specs = split(arguments)
    if not specs:
        raise SpecError("no model is given: name laws, such as coulomb+offset or coulomb+load")
    motion = read_runs(described, runs, reading, cutoff)
    others = [read_runs(described, (path,), reading, motion.cutoff) for path in evaluate]
    found = compare_robots(
        motion, specs, payload=payload, evaluate=others, starts=starts, seed=seed
    )
    robot_report(found, report)
    echo_result(found, as_json)


@robot.command(cls=CheckedCommand)
@loop_options
@refusing(OF_A_DIAGNOSIS)
def diagnose(
    runs: tuple[str, ...],
    described: Robot,
    base: str | None,
    joint_model: tuple[str, ...],
    payload: tuple[str, ...],
    cutoff: float | None,
    least_fall: float,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Find which effect each joint lacks, and causes in the rigid bodies, on RUNS."""
    runs, base = split_one(runs, "--base", base)
    motion = read_runs(described, runs, reading, cutoff)
    found = improve_robot(
        motion,
        base or ORDINARY,
        of_joints=by_joint(joint_model),
        payload=payload,
        starts=starts,
        seed=seed,
        least_fall=least_fall,
        most_steps=0,
        progress=lambda sentence: say(f"note: {sentence}"),
    )
    echo_result(RobotDiagnosis.of(found), as_json)


@robot.command(cls=CheckedCommand)
@loop_options
@output_option
@evaluate_option
@click.option(
    "--max-steps",
    type=click.IntRange(min=0),
    default=MOST_STEPS,
    show_default=True,
    help="Largest number of effects to add to one joint.",
)
@report_option
def improve(
    runs: tuple[str, ...],
    described: Robot,
    base: str | None,
    joint_model: tuple[str, ...],
    payload: tuple[str, ...],
    evaluate: tuple[str, ...],
    output: str | None,
    cutoff: float | None,
    least_fall: float,
    max_steps: int,
    starts: int,
    reading: ReadOptions,
    seed: int,
    report: str | None,
    as_json: bool,
) -> None:
    """Add to each joint the effects that it lacks, all joints identified together on RUNS."""
    runs, base = split_one(runs, "--base", base)
    motion = read_runs(described, runs, reading, cutoff)
    others = [read_runs(described, (path,), reading, motion.cutoff) for path in evaluate]
    found = improve_robot(
        motion,
        base or ORDINARY,
        of_joints=by_joint(joint_model),
        payload=payload,
        evaluate=others,
        starts=starts,
        seed=seed,
        least_fall=least_fall,
        most_steps=max_steps,
        progress=lambda sentence: say(f"note: {sentence}"),
    )
    _save(found.final, output)
    robot_report(found, report)
    echo_result(found, as_json, lambda: robot_toml(found.final))


@robot.command(cls=CheckedCommand)
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
    if output is None:
        raise SpecError("nothing would be kept: give the recording to write, -o FILE")
    usual = 200.0 if rate is None else rate
    made = simulate_robot(
        arm, friction, seconds=seconds, rate=usual, speed=speed, noise=noise, seed=seed
    )
    _write(made, output)


def _write(made: pl.DataFrame, output: str) -> None:
    """Write a recording."""
    content = file_bytes(made, Path(output).suffix.lower())
    write_table(output, content, 'kind = "recording"\n', RecordingError)
    say(f"wrote {output}")


@robot.command(cls=CheckedCommand)
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


robot.add_command(export)
