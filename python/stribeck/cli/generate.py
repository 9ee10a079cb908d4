"""`stribeck generate`: synthetic recordings of one joint, or of a robot arm."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
import polars as pl

from stribeck.base.files import write_table, write_whole
from stribeck.cli.common import echo_json, json_option, seed_option
from stribeck.cli.options import Values
from stribeck.cli.outputs import TABLE, CheckedCommand
from stribeck.cli.unread import refuse_unread
from stribeck.motion.generate.files import file_bytes, sidecar_text, write_robot
from stribeck.motion.generate.hidden import Truth
from stribeck.motion.generate.hidden import generate as make
from stribeck.motion.generate.motion import JOINTS
from stribeck.motion.generate.ur5e import RATE, REPEATS, TESTS, RobotRecording
from stribeck.report.layout import table
from stribeck.report.numbers import listed, plain, thousands, unit_text

#: Options that belong to one of the two kinds of recording.
OF_A_JOINT = ("effects", "law", "seconds", "noise", "warming", "joint_kind")
OF_A_ROBOT = ("test", "repeats", "every")


@click.command(cls=CheckedCommand)
@click.option(
    "-o",
    "--output",
    required=True,
    type=TABLE,
    help="Recording to write: .parquet or .csv.",
)
@click.option(
    "--effect",
    "effects",
    multiple=True,
    metavar="EFFECT",
    help="Hide this effect; may be repeated (`stribeck effects` lists them).",
)
@click.option("--law", default="coulomb", show_default=True, help="Friction law, or published:ID.")
@click.option("--seconds", default=120.0, show_default=True, help="Duration, s.")
@click.option(
    "--rate",
    type=float,
    default=None,
    help=f"Sampling rate, Hz. [default: 200; {RATE:g} with --robot]",
)
@click.option(
    "--noise",
    default=0.02,
    show_default=True,
    help="RMS of the torque noise, as a share of Coulomb friction.",
)
@click.option("--warming", default=20.0, show_default=True, help="Warm-up of the joint, K.")
@click.option("--joint-kind", default="revolute", show_default=True, type=click.Choice([*JOINTS]))
@click.option(
    "--robot",
    type=click.Choice(["ur5e"]),
    default=None,
    help="An arm of six joints; its friction is none of the laws.",
)
@click.option(
    "--test",
    type=click.Choice([str(t) for t in TESTS]),
    default="2",
    show_default=True,
    help="Motion of the robot: 1 trapezoidal speed, 2 quintic polynomials.",
)
@click.option(
    "--repeats",
    type=int,
    default=None,
    help=f"Cycles of the motion. [default: 1 in test 1, {REPEATS} in test 2]",
)
@click.option(
    "--every",
    type=int,
    default=1,
    show_default=True,
    help="Record every n-th cycle; the robot warms up in all of them.",
)
@seed_option
@json_option
def generate(
    output: str,
    robot: str | None,
    rate: float | None,
    seed: int,
    as_json: bool,
    **sizes: Any,
) -> None:
    """Make a synthetic recording: a joint with hidden effects, or a robot arm.

    The sidecar and the hidden truth (.truth.json) are written beside the recording.
    """
    target = Path(output)
    if robot is None:
        refuse_unread("for a single joint", dict.fromkeys(OF_A_ROBOT, "with --robot"))
        _generate_joint(target, sizes, 200.0 if rate is None else rate, seed, as_json)
    else:
        refuse_unread(f"with --robot {robot}", dict.fromkeys(OF_A_JOINT, "for a single joint"))
        _generate_robot(target, sizes, RATE if rate is None else rate, seed, as_json)


def _generate_joint(target: Path, sizes: Values, rate: float, seed: int, as_json: bool) -> None:
    own = {name: sizes[name] for name in OF_A_JOINT if name != "effects"}
    frame, truth = make(sizes["effects"], rate=rate, seed=seed, **own)
    write_table(target, file_bytes(frame, target.suffix.lower()), sidecar_text(truth))
    beside = _write_truth(target, truth)
    if as_json:
        echo_json({"path": str(target), **beside, "rows": frame.height, **truth})
    else:
        click.echo(_joint_text(target, beside["truth_path"], frame, truth))


def _generate_robot(target: Path, sizes: Values, rate: float, seed: int, as_json: bool) -> None:
    test, repeats = int(sizes["test"]), sizes["repeats"]
    if repeats is None:
        repeats = 1 if test == 1 else REPEATS
    recording = RobotRecording(
        test=test, seed=seed, repeats=repeats, every=sizes["every"], rate=rate
    )
    write_robot(recording, target)
    truth = recording.truth()
    beside = _write_truth(target, truth)
    if as_json:
        echo_json({"path": str(target), **beside, **truth})
    else:
        click.echo(_robot_text(target, beside["truth_path"], truth))


def _write_truth(target: Path, truth: Truth) -> dict[str, str]:
    """Write the truth beside the recording, and return the paths of truth and sidecar."""
    truth_path = target.with_name(f"{target.name}.truth.json")
    write_whole(truth_path, json.dumps(truth, indent=2) + "\n")
    return {"truth_path": str(truth_path), "sidecar_path": f"{target}.sidecar.toml"}


def _joint_text(path: Path, truth_path: str, frame: pl.DataFrame, truth: Truth) -> str:
    unit = truth["torque_unit"]
    rows = [["parameter", "value", "unit"]]
    rows += [
        [name, plain(p["value"], 4), unit_text(p["unit"])]
        for name, p in truth["parameters"].items()
    ]
    hidden = ", ".join(truth["hidden"]) or "nothing"
    return "\n".join(
        [
            f"wrote {path}: {frame.height} samples, {plain(truth['seconds'])} s at "
            f"{plain(truth['rate_hz'])} Hz, {truth['joint_kind']} joint",
            "",
            f"  hidden: {hidden} (model {truth['spec']})",
            f"  torque noise: {plain(truth['noise_rms'])} {unit} RMS, seed {truth['seed']}",
            "",
            table(rows, right=(1,)),
            "",
            f"The truth is in {truth_path}. Next:",
            f"  stribeck improve {path} --base {truth['law']}",
        ]
    )


def _robot_text(path: Path, truth_path: str, truth: Truth) -> str:
    cycles = len(range(0, truth["repeats"], truth["every"]))
    made = f"{truth['repeats']} cycle{'s' if truth['repeats'] > 1 else ''}"
    motion = f"{truth['motion']}, {made} of {plain(truth['cycle_s'])} s, {cycles} recorded"
    return "\n".join(
        [
            f"wrote {path}: {thousands(truth['rows'])} samples at {plain(truth['rate_hz'])} Hz",
            "",
            f"  joints: {listed(list(truth['joints']))}",
            f"  motion: {motion}",
            f"  friction: none of the laws; parameters, noise and motors are in {truth_path}",
            "",
            "Next:",
            f"  stribeck study {path} --output study",
        ]
    )
