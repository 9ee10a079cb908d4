"""`stribeck robot`: whole robots."""

from __future__ import annotations

import click

from stribeck.base.errors import SpecError
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
from stribeck.cli.outputs import CheckedCommand
from stribeck.cli.refused import OF_A_DIAGNOSIS, OF_A_ROBOT, refusing
from stribeck.cli.robot_export import export
from stribeck.cli.robot_motion import plan, simulate
from stribeck.cli.robot_options import (
    by_joint,
    cutoff_option,
    evaluate_option,
    joint_model_option,
    known_payload_options,
    loop_options,
    output_option,
    payload_option,
    robot_options,
    runs_argument,
)
from stribeck.cli.robot_page import robot_report
from stribeck.cli.robot_runs import Passes, passes_options, read_runs
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.compare import compare_robots
from stribeck.robot.describe import read_robot
from stribeck.robot.diagnosis import RobotDiagnosis
from stribeck.robot.drive_gains import KnownPayload
from stribeck.robot.fit import ORDINARY, fit_robot
from stribeck.robot.improve import MOST_STEPS, improve_robot
from stribeck.robot.result import RobotFit
from stribeck.robot.stored import robot_toml, write_robot


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
            "motor_turns": [list(row) for row in found.coupling] or None,
            "encoders": found.encoders,
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
@known_payload_options
@evaluate_option
@cutoff_option
@starts_option
@recording_options
@passes_options
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
    known_payload: KnownPayload | None,
    evaluate: tuple[str, ...],
    cutoff: float | None,
    starts: int,
    reading: ReadOptions,
    passes: Passes,
    seed: int,
    output: str | None,
    report: str | None,
    as_json: bool,
) -> None:
    """Identify base parameters of the rigid bodies and the friction of every joint."""
    runs, spec = split_one(runs, "--model", spec)
    with passes.open(described, runs, reading, cutoff, seed) as data:
        others = [read_runs(described, (path,), reading, data.cutoff) for path in evaluate]
        found = fit_robot(
            data,
            spec or ORDINARY,
            of_joints=by_joint(joint_model),
            payload=payload,
            known_payload=known_payload,
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
@passes_options
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
    passes: Passes,
    seed: int,
    report: str | None,
    as_json: bool,
) -> None:
    """Compare laws, each on all joints, with RUNS."""
    runs, specs = split(arguments)
    if not specs:
        raise SpecError("no model is given: name laws, such as coulomb+offset or coulomb+load")
    with passes.open(described, runs, reading, cutoff, seed) as data:
        others = [read_runs(described, (path,), reading, data.cutoff) for path in evaluate]
        found = compare_robots(
            data, specs, payload=payload, evaluate=others, starts=starts, seed=seed
        )
    robot_report(found, report)
    echo_result(found, as_json)


@robot.command(cls=CheckedCommand)
@loop_options
@refusing(OF_A_DIAGNOSIS)
@report_option
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
    passes: Passes,
    seed: int,
    report: str | None,
    as_json: bool,
) -> None:
    """Find which effect each joint lacks, and causes in the rigid bodies, on RUNS."""
    runs, base = split_one(runs, "--base", base)
    with passes.open(described, runs, reading, cutoff, seed) as data:
        found = improve_robot(
            data,
            base or ORDINARY,
            of_joints=by_joint(joint_model),
            payload=payload,
            starts=starts,
            seed=seed,
            least_fall=least_fall,
            most_steps=0,
            progress=lambda sentence: say(f"note: {sentence}"),
        )
    diagnosis = RobotDiagnosis.of(found)
    robot_report(diagnosis, report)
    echo_result(diagnosis, as_json)


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
    passes: Passes,
    seed: int,
    report: str | None,
    as_json: bool,
) -> None:
    """Add to each joint the effects that it lacks, all joints identified together on RUNS."""
    runs, base = split_one(runs, "--base", base)
    with passes.open(described, runs, reading, cutoff, seed) as data:
        others = [read_runs(described, (path,), reading, data.cutoff) for path in evaluate]
        found = improve_robot(
            data,
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


robot.add_command(simulate)
robot.add_command(plan)
robot.add_command(export)
