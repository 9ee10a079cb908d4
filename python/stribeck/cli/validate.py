"""`stribeck validate`: simulate a model under the measured torque; compare the motion."""

from __future__ import annotations

import click

from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure
from stribeck.cli.common import (
    echo_result,
    json_option,
    model_fit,
    read_recording,
    recording_options,
    say,
    seed_option,
    starts_option,
)
from stribeck.cli.data import arguments_of_both, split
from stribeck.cli.outputs import FIGURE, CheckedCommand
from stribeck.cli.refused import OF_A_SPEC, refusing
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.validation import validate as drive
from stribeck.recording.stated.options import ReadOptions


@click.command(cls=CheckedCommand)
@arguments_of_both
@click.option(
    "--plot",
    "picture",
    type=FIGURE,
    metavar="FILE",
    help="Write a figure of both motions (PNG, SVG, PDF).",
)
@refusing(OF_A_SPEC)
@starts_option
@recording_options
@seed_option
@json_option
def validate(
    arguments: tuple[str, ...],
    picture: str | None,
    starts: int,
    reading: ReadOptions,
    seed: int,
    as_json: bool,
) -> None:
    """Simulate MODEL under the torque of DATA alone, and compare the motion.

    A spec is fitted to DATA first. Without --inertia, the identified rigid body is used.
    """
    data, models = split(arguments)
    if len(models) != 1:
        raise SpecError(
            f"one model is needed beside the data, not {len(models)}: write `stribeck validate "
            f"DATA MODEL`"
        )
    recording = read_recording(data, reading)
    fitted = model_fit(models[0], recording, starts=starts, seed=seed)
    inertia = reading.inertia
    if inertia is None and "inertia" not in (*fitted.model.effects, *fitted.model.rigid_body):
        raise SpecError(
            f"{fitted.model.spec} has no inertia to move, because {recording.path} gives the load "
            f"torque: give that of the joint with --inertia (kg m2; of a prismatic joint its mass, "
            f"kg)"
        )
    joint = None if inertia is None else Joint(inertia, kind=recording.joint_kind)
    validation = drive(fitted, recording, joint)
    if picture is not None:
        save_figure(validation.plot(), picture)
        say(f"wrote {picture}")
    echo_result(validation, as_json)
