"""`stribeck compensate`: friction compensation of a joint."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from stribeck.base.errors import SpecError
from stribeck.base.files import save_figure
from stribeck.cli.common import (
    echo_json,
    is_model_file,
    json_option,
    say,
    seed_option,
)
from stribeck.cli.motion import (
    check_joint,
    joint_of,
    joint_options,
    model_of,
    trajectory_of,
    trajectory_options,
    value_option,
)
from stribeck.cli.options import Values
from stribeck.cli.outputs import FIGURE, CheckedCommand
from stribeck.cli.unread import refuse_unread
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.reader import read_model_file
from stribeck.motion.compensate.controller import BANDWIDTH, HInfinity
from stribeck.motion.compensate.factor import Factor, largest_factor
from stribeck.motion.compensate.loop import Compensator
from stribeck.motion.compensate.teaching import Guidance, Teaching, teach
from stribeck.motion.compensate.tracking import Tracking
from stribeck.motion.compensate.tracking import compensate as follow
from stribeck.motion.simulate.acting import take_apart
from stribeck.passivity.operating_box import parse_sides

LARGEST = "largest"
#: Options of the controller, which a hand replaces.
CONTROLLER = dict.fromkeys(
    ("observer", "bandwidth", "kp", "ki", "gain", "picture"), "without it, with the controller"
)


@click.command(cls=CheckedCommand)
@click.argument("model")
@value_option
@click.option(
    "--with",
    "others",
    multiple=True,
    metavar="FILE",
    help="Also compensate with this model, for comparison.",
)
@click.option("--plant", metavar="FILE", help="Friction of the simulated joint. [default: MODEL]")
@click.option(
    "--factor",
    "share",
    default="1",
    show_default=True,
    help="Compensated share of the friction, 0 to 1; 'largest': proved not to overcompensate.",
)
@click.option(
    "--box",
    "sides",
    multiple=True,
    metavar="CHANNEL=LOW:HIGH",
    help="Box in which 'largest' is proved. [default: that of the model file]",
)
@click.option(
    "--feedforward",
    is_flag=True,
    help="Compensate from the desired velocity, not the measured one.",
)
@click.option("--guided", is_flag=True, help="A hand leads the joint; the motor only compensates.")
@click.option(
    "--observer", type=float, help="Bandwidth of a friction observer, Hz. [default: none]"
)
@click.option(
    "--encoder",
    type=float,
    default=0.0,
    show_default=True,
    help="Resolution of the encoder, rad or m; 0: exact.",
)
@joint_options
@trajectory_options
@click.option(
    "--bandwidth",
    type=float,
    default=BANDWIDTH,
    show_default=True,
    help="Bandwidth of the H-infinity PID if no gains are given, Hz.",
)
@click.option("--kp", type=float, help="Gain Kp of the H-infinity PID, 1/s.")
@click.option("--ki", type=float, help="Gain KI, 1/s2, with Kp^2 > 2 KI.")
@click.option("--gain", type=float, help="Gain K + 1/gamma^2, N m s/rad or N s/m.")
@click.option("--seconds", type=float, help="Duration, s. [default: there and back]")
@click.option("--step", type=float, default=1e-3, show_default=True, help="Time step, s.")
@click.option(
    "--temperature", type=float, help="Temperature, degC. [default: middle of the plant's box]"
)
@click.option(
    "--plot",
    "picture",
    type=FIGURE,
    metavar="FILE",
    help="Write a figure of the errors (PNG, SVG, PDF).",
)
@seed_option
@json_option
def compensate(
    model: str,
    values: tuple[str, ...],
    others: tuple[str, ...],
    plant: str | None,
    share: str,
    sides: tuple[str, ...],
    feedforward: bool,
    guided: bool,
    observer: float | None,
    encoder: float,
    seconds: float | None,
    step: float,
    temperature: float | None,
    picture: str | None,
    seed: int,
    as_json: bool,
    **sizes: Any,
) -> None:
    """Track a trajectory without friction compensation, and with that of MODEL.

    The controller is the H-infinity PID of Tadese et al. 2021, or a hand (direct teaching). The
    simulated joint has the friction of --plant. Without --inertia or --mass, the rigid body is the
    one that was identified with the friction.
    """
    asked = _known(model, values)
    friction = asked if plant is None else _known(plant)
    joint = joint_of(sizes)
    check_joint(model if plant is None else plant, _model_of(friction), joint)
    moved = take_apart(_model_of(friction), joint).joint
    cancels = [_known(other) for other in others] + [asked]
    factors = [_factor(share, each, friction, sides) for each in cancels]
    compensators = [
        Compensator(_model_of(each), _share(factor), feedback=not feedforward)
        for each, factor in zip(cancels, factors, strict=True)
    ]
    path = trajectory_of(sizes, moved, seed)
    course: Values = dict(seconds=seconds, step=step, temperature=temperature, encoder=encoder)
    result: Tracking | Teaching
    if guided:
        refuse_unread("with --guided", CONTROLLER)
        hand = Guidance.with_bandwidth(path, moved.inertia)
        result = teach(friction, joint, hand, compensators, **course)
    else:
        gains = _gains(sizes, moved.inertia)
        result = follow(
            friction, joint, path, compensators, controller=gains, observer=observer, **course
        )
        if picture is not None:
            save_figure(result.plot(), picture)
            say(f"wrote {picture}")
    proofs = [factor for factor in factors if isinstance(factor, Factor)]
    if as_json:
        echo_json({**result.to_dict(), "factors": [proof.to_dict() for proof in proofs]})
    else:
        click.echo("\n".join(map(repr, (result, *proofs))))


def _known(argument: str, values: tuple[str, ...] = ()) -> Model | ModelFile:
    """A model with its values, or a model file with its standard errors."""
    if is_model_file(argument) and not values:
        return read_model_file(argument)
    return model_of(argument, values)


def _model_of(known: Model | ModelFile) -> Model:
    return known if isinstance(known, Model) else known.model


def _share(factor: Factor | float) -> float:
    return factor.value if isinstance(factor, Factor) else factor


def _factor(
    text: str, compensator: Model | ModelFile, friction: Model | ModelFile, sides: tuple[str, ...]
) -> Factor | float:
    """The factor, as given or as proved."""
    if text == LARGEST:
        return largest_factor(compensator, friction, parse_sides(sides))
    refuse_unread(f"with --factor {text}", {"sides": f"with --factor {LARGEST}"})
    try:
        return float(text)
    except ValueError:
        raise SpecError(f"--factor {text}: give a number from 0 to 1, or largest") from None


def _gains(sizes: Values, inertia: float) -> HInfinity:
    """The given gains; the others follow from the bandwidth."""
    usual = HInfinity.with_bandwidth(inertia, sizes["bandwidth"])
    given = {"proportional": sizes["kp"], "integral": sizes["ki"], "gain": sizes["gain"]}
    if None not in given.values():
        refuse_unread("with --kp, --ki and --gain", {"bandwidth": "without one of them"})
    return replace(usual, **{name: gain for name, gain in given.items() if gain is not None})
