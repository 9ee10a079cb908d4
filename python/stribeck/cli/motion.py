"""Options of a joint and its trajectory, and how they are read."""

from __future__ import annotations

import math
from dataclasses import dataclass

import click

from stribeck.base.errors import SpecError
from stribeck.cli.common import is_model_file
from stribeck.cli.options import Command, Values, added
from stribeck.cli.unread import refuse_unread
from stribeck.models.build import model as named
from stribeck.models.model import Model
from stribeck.models.reader import load
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Fourier, Quintic, Trajectory, Trapezoid


@dataclass(frozen=True)
class Usual:
    """Defaults for a kind of joint: rad or m, and per s, s2."""

    stroke: float
    speed: float
    acceleration: float


USUAL = {"revolute": Usual(1.0, 1.0, 5.0), "prismatic": Usual(0.2, 0.1, 0.5)}

#: Options that not every trajectory reads, and those that do.
_TRAJECTORIES = {
    "speed": ("quintic", "trapezoid"),
    "dwell": ("quintic", "trapezoid"),
    "acceleration": ("trapezoid",),
    "period": ("fourier",),
}
#: Where the options that not every joint reads have an effect.
_OF_REVOLUTE = dict.fromkeys(("gravity_cos", "gravity_sin"), "with --inertia")
_OF_PRISMATIC = dict.fromkeys(("gravity", "rotor_inertia", "pitch"), "with --mass")
#: Arguments of the options of a trajectory.
OF_A_TRAJECTORY = ("path", "start", "end", *_TRAJECTORIES)

# fmt: off
value_option = click.option(
    "--value", "values", multiple=True, metavar="NAME=NUMBER",
    help="Value of a parameter, if MODEL is not a file.",
)
_JOINT = (
    click.option("--inertia", type=float, help="Inertia of a revolute joint, kg m2."),
    click.option("--gravity-cos", type=float, default=0.0, help="Gravity torque at 0 rad, N m."),
    click.option("--gravity-sin", type=float, default=0.0, help="Gravity torque at pi/2, N m."),
    click.option("--mass", type=float, help="Mass of a prismatic joint, kg."),
    click.option("--gravity", type=float, default=0.0, help="Gravity force along the axis, N."),
    click.option("--rotor-inertia", type=float, help="Inertia of motor and ball screw, kg m2."),
    click.option("--pitch", type=float, help="Travel per turn of the ball screw, m."),
)
_TRAJECTORY = (
    click.option(
        "--trajectory", "path", type=click.Choice(["trapezoid", "quintic", "fourier"]),
        default="quintic", show_default=True, help="The desired motion.",
    ),
    click.option(
        "--from", "start", type=float, default=0.0, help="Start of a stroke, rad or m.",
    ),
    click.option("--to", "end", type=float, help="End of a stroke; reach of a Fourier series."),
    click.option("--speed", type=float, help="Largest speed of a stroke, rad/s or m/s."),
    click.option("--acceleration", type=float, help="Acceleration of a trapezoid, rad/s2 or m/s2."),
    click.option(
        "--dwell", type=float, default=0.5, show_default=True, help="Rest at the ends, s.",
    ),
    click.option("--period", type=float, default=10.0, help="Period of a Fourier series, s."),
)
# fmt: on


def joint_options(command: Command) -> Command:
    """Add the options that `joint_of` reads."""
    return added(_JOINT, command)


def trajectory_options(command: Command) -> Command:
    """Add the options that `trajectory_of` reads."""
    return added(_TRAJECTORY, command)


def model_of(argument: str, values: tuple[str, ...]) -> Model:
    """The model of an argument, with the values of --value."""
    if is_model_file(argument):
        if values:
            raise SpecError(f"--value {values[0]}: {argument} has values already, omit it")
        return load(argument)
    given: Values = {}
    for text in values:
        name, _, number = text.partition("=")
        try:
            given[name.strip()] = float(number)
        except ValueError:
            raise SpecError(f"--value {text}: write --value NAME=NUMBER") from None
    return named(argument, **given)


def check_joint(argument: str, known: Model, joint: Joint | None) -> None:
    """Refuse to put the friction of a revolute joint, from a file, on a prismatic one."""
    prismatic = joint is not None and joint.kind == "prismatic"
    if prismatic and is_model_file(argument) and known.position_unit == "rad":
        raise SpecError(f"{argument} is in N m and rad: give --inertia, not --mass")


def joint_of(sizes: Values) -> Joint | None:
    """The joint that the options describe; None if they describe none."""
    inertia, mass = sizes["inertia"], sizes["mass"]
    screw = (sizes["rotor_inertia"], sizes["pitch"])
    if inertia is not None and mass is not None:
        raise SpecError("--inertia is for a revolute joint, --mass for a prismatic one: give one")
    if inertia is None and mass is None:
        refuse_unread("with the rigid body of MODEL", {**_OF_REVOLUTE, **_OF_PRISMATIC})
        return None
    if mass is None:
        refuse_unread("with --inertia", _OF_PRISMATIC)
        return Joint.revolute(
            inertia, gravity_cos=sizes["gravity_cos"], gravity_sin=sizes["gravity_sin"]
        )
    refuse_unread("with --mass", _OF_REVOLUTE)
    if screw == (None, None):
        return Joint.prismatic(mass, gravity=sizes["gravity"])
    if None in screw:
        raise SpecError("a ball screw needs both --rotor-inertia and --pitch")
    return Joint.ball_screw(mass, *screw, gravity=sizes["gravity"])


def at_the_joint(sizes: Values) -> float:
    """Force or torque at the joint per torque of the motor: ``2 pi/p`` of a ball screw, else 1."""
    pitch = sizes["pitch"]
    return 1.0 if pitch is None else math.tau / float(pitch)


def trajectory_of(sizes: Values, joint: Joint, seed: int) -> Trajectory:
    """The trajectory that the options describe; those that it does not read are refused."""
    unread = {
        name: f"with --trajectory {' or '.join(readers)}"
        for name, readers in _TRAJECTORIES.items()
        if sizes["path"] not in readers
    }
    refuse_unread(f"with --trajectory {sizes['path']}", unread)
    usual = USUAL[joint.kind]
    start = sizes["start"]
    end = start + usual.stroke if sizes["end"] is None else sizes["end"]
    if sizes["path"] == "fourier":
        return Fourier.from_rest(abs(end - start), sizes["period"], seed=seed, centre=start)
    speed = usual.speed if sizes["speed"] is None else sizes["speed"]
    if sizes["path"] == "quintic":
        if not speed > 0.0:
            raise SpecError(f"--speed {speed:g}: give a speed above 0")
        # The largest speed of the polynomial is 15/8 of the mean.
        return Quintic(start, end, 1.875 * abs(end - start) / speed, sizes["dwell"])
    acceleration = usual.acceleration if sizes["acceleration"] is None else sizes["acceleration"]
    return Trapezoid(start, end, speed, acceleration, sizes["dwell"])
