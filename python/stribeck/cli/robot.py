"""`stribeck robot`: whole robots."""

from __future__ import annotations

from pathlib import Path

import click

from stribeck.base.errors import RecordingError, SpecError
from stribeck.base.files import write_table
from stribeck.cli.common import (
    echo_json,
    echo_result,
    json_option,
    least_fall_option,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import split
from stribeck.cli.options import Command, Values, added, gathered
from stribeck.cli.outputs import ROBOT, TABLE, URDF, CheckedCommand
from stribeck.motion.generate.files import file_bytes
from stribeck.recording.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.compare import compare_robots
from stribeck.robot.describe import read_robot
from stribeck.robot.diagnosis import RobotDiagnosis
from stribeck.robot.fit import ORDINARY, fit_robot
from stribeck.robot.improve import MOST_STEPS, improve_robot
from stribeck.robot.motion import RobotMotion, read_motion
from stribeck.robot.result import RobotFit
from stribeck.robot.simulate import simulate_robot
from stribeck.robot.stored import read_friction, write_robot
from stribeck.robot.updated_urdf import write_urdf

output_option = click.option(
    "-o",
    "--output",
    type=ROBOT,
    default=None,
    help="Write the identified robot to this file (TOML).",
)
runs_argument = click.argument("runs", nargs=-1, required=True, metavar="RUNS...")
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


def robot_options(command: Command) -> Command:
    """Add `--robot` and `--urdf`; the command receives the robot as `described`."""
    options = (
        click.option("--robot", "robot_file", default=None, metavar="FILE", help="Robot file."),
        click.option("--urdf", default=None, metavar="FILE", help="URDF of the robot."),
    )

    def build(values: Values) -> Robot:
        given = [path for path in (values.pop("robot_file"), values.pop("urdf")) if path]
        if len(given) != 1:
            raise SpecError("one description of the robot is needed: --robot FILE or --urdf FILE")
        return read_robot(given[0])

    return gathered(command, options, "described", build)


@click.group()
def robot() -> None:
    """Identify the rigid bodies of a robot and the friction of all its joints.

    RUNS are recordings of all joints; several are runs of one robot.
    """


@robot.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@json_option
def show(described: str, as_json: bool) -> None:
    """Show the joints of ROBOT (a robot file or a URDF), and what torques can show of it."""
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


def read_runs(
    described: Robot, runs: tuple[str, ...], reading: ReadOptions, cutoff: float | None
) -> RobotMotion:
    """Read the recordings of all joints, and refuse channels that contradict each other."""
    motion = read_motion(described, runs, reading, cutoff)
    for recording in motion.joints:
        recording.require_consistent()
        for check in recording.checks:
            if not check.ok:
                say(f"note: joint {recording.joint}: accepted with --trust: {check.said}")
    return motion


def by_joint(given: tuple[str, ...]) -> dict[str, str]:
    """`JOINT=SPEC` texts as a mapping."""
    made = {}
    for text in given:
        name, equals, spec = text.partition("=")
        if not equals or not name or not spec:
            raise SpecError(f"--joint-model {text}: write JOINT=SPEC, such as 2=coulomb+load")
        made[name.strip()] = spec.strip()
    return made


@robot.command(cls=CheckedCommand)
@runs_argument
@robot_options
@click.option("--model", "spec", default=ORDINARY, show_default=True, help="LAW[+effect...].")
@joint_model_option
@payload_option
@evaluate_option
@cutoff_option
@starts_option
@recording_options
@seed_option
@output_option
@json_option
def fit(
    runs: tuple[str, ...],
    described: Robot,
    spec: str,
    joint_model: tuple[str, ...],
    payload: tuple[str, ...],
    evaluate: tuple[str, ...],
    cutoff: float | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    output: str | None,
    as_json: bool,
) -> None:
    """Identify base parameters of the rigid bodies and the friction of every joint."""
    motion = read_runs(described, runs, reading, cutoff)
    others = [read_runs(described, (path,), reading, motion.cutoff) for path in evaluate]
    found = fit_robot(
        motion,
        spec,
        of_joints=by_joint(joint_model),
        payload=payload,
        evaluate=others,
        starts=starts,
        seed=seed,
    )
    _save(found, output)
    echo_result(found, as_json)


def _save(found: RobotFit, output: str | None) -> None:
    if output is not None:
        write_robot(found, output)
        say(f"wrote {output}")


@robot.command(cls=CheckedCommand)
@click.argument("arguments", nargs=-1, required=True, metavar="RUNS... SPEC...")
@robot_options
@payload_option
@evaluate_option
@cutoff_option
@starts_option
@recording_options
@seed_option
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
    echo_result(found, as_json)


def loop_options(command: Command) -> Command:
    """Add the options that `diagnose` and `improve` share."""
    return added(
        (
            runs_argument,
            robot_options,
            click.option("--base", default=ORDINARY, show_default=True, help="LAW[+effect...]."),
            joint_model_option,
            payload_option,
            cutoff_option,
            least_fall_option,
            starts_option,
            recording_options,
            seed_option,
            json_option,
        ),
        command,
    )


@robot.command(cls=CheckedCommand)
@loop_options
def diagnose(
    runs: tuple[str, ...],
    described: Robot,
    base: str,
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
    motion = read_runs(described, runs, reading, cutoff)
    found = improve_robot(
        motion,
        base,
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
def improve(
    runs: tuple[str, ...],
    described: Robot,
    base: str,
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
    as_json: bool,
) -> None:
    """Add to each joint the effects that it lacks, all joints identified together on RUNS."""
    motion = read_runs(described, runs, reading, cutoff)
    others = [read_runs(described, (path,), reading, motion.cutoff) for path in evaluate]
    found = improve_robot(
        motion,
        base,
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
    echo_result(found, as_json)


@robot.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@click.option("--seconds", type=float, default=30.0, show_default=True, help="Duration [s].")
@click.option("--rate", type=float, default=200.0, show_default=True, help="Samples per second.")
@click.option("--speed", type=float, default=1.0, show_default=True, help="RMS speed of a joint.")
@click.option(
    "--noise", type=float, default=0.01, show_default=True, help="Noise as a share of the torque."
)
@click.option("-o", "--output", type=TABLE, required=True, help="Recording to write.")
@seed_option
def simulate(
    described: str,
    seconds: float,
    rate: float,
    speed: float,
    noise: float,
    output: str,
    seed: int,
) -> None:
    """Make a recording of ROBOT, as written by `stribeck robot fit -o`, on a Fourier motion."""
    made = simulate_robot(
        read_robot(described),
        read_friction(described),
        seconds=seconds,
        rate=rate,
        speed=speed,
        noise=noise,
        seed=seed,
    )
    content = file_bytes(made, Path(output).suffix.lower())
    write_table(output, content, 'kind = "recording"\n', RecordingError)
    say(f"wrote {output}")


@robot.command(cls=CheckedCommand)
@click.argument("described", metavar="ROBOT")
@click.option("--urdf", "source", required=True, metavar="FILE", help="URDF of the robot.")
@click.option("-o", "--output", type=URDF, required=True, help="URDF to write.")
def export(described: str, source: str, output: str) -> None:
    """Write a URDF with the inertia, damping and friction of ROBOT, a file of `robot fit -o`."""
    write_urdf(output, source, read_robot(described), read_friction(described))
    say(f"wrote {output}")
