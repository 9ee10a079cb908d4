"""Simulate a joint with a friction model: open loop, in closed loop, or pulled by a spring."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.simulate.acting import take_apart
from stribeck.motion.simulate.drive import Drive, Follow, Pull, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.result import Simulation

Array = NDArray[np.float64]

#: Steps of one simulation: 2 GB of numbers.
MOST_STEPS = 10_000_000


def simulate(
    model: Model | ModelFile | Fit,
    joint: Joint | None,
    drive: Drive,
    *,
    seconds: float | None = None,
    step: float | Array = 1e-3,
    position: float | None = None,
    velocity: float | None = None,
    deflection: float = 0.0,
    temperature: ArrayLike | None = None,
    external_torque: ArrayLike = 0.0,
) -> Simulation:
    """Move a joint with friction, step by step.

    Parameters
    ----------
    model : Model, ModelFile or Fit
        With values for all parameters. What it says of the measurement (delay, gain, saturation)
        is left out.
    joint : Joint, optional
        What friction acts on; None: the inertia and gravity identified with the friction.
    drive : Torque, Follow or Pull
        What moves the joint.
    seconds : float, optional
        How long. The default is the trajectory's, or as long as the torque is given.
    step : float or array [steps]
        s; the controller's sampling time too.
    position, velocity : float, optional
        At the start, rad or m; the default is where the trajectory begins, else 0.
    deflection : float
        Of the bristle at the start, rad or m.
    temperature : float or array [steps], optional
        degC; the default is the middle of the model's operating box.
    external_torque : float or array [steps]
        Along positive motion, N m or N.

    Returns
    -------
    Simulation

    Raises
    ------
    SpecError
        Something is missing, or cannot be.

    Notes
    -----
    The implicit midpoint rule with the exact mean of the friction over the step: stable for any
    step, and energy balances to rounding. A model without a memory holds the joint at rest by any
    torque up to its level: such a joint stands exactly still.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> friction = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> pushed = simulate(friction, Joint.revolute(0.1), Torque(1.9), seconds=60.0)
    >>> float(pushed.position_end)
    0.0
    """
    asked = model if isinstance(model, Model) else model.model
    acting = take_apart(asked, joint)
    instants = _instants(drive, seconds, step)
    count = instants.size - 1
    start = _start(drive, position, velocity)
    if not math.isfinite(deflection):
        raise SpecError(f"deflection {deflection} at the start cannot be: give a number")
    columns = _columns(drive, acting.joint, instants, start[0])
    columns["temperature"] = column("temperature", _warmth(asked, temperature), count)
    columns["external"] = column("external torque", external_torque, count)
    try:
        answer = _core.simulate(
            acting.friction.core,
            acting.friction.values,
            _sizes(acting.joint, drive),
            columns,
            start,
            deflection,
            _gains(drive),
            _apart(acting.joint),
        )
    except _core.ModelError as error:
        raise SpecError(f"{asked.spec} cannot be simulated: {error}") from None
    return Simulation(
        model=asked,
        joint=acting.joint,
        drive=drive,
        instants=instants,
        left_out=acting.left_out,
        temperature=columns["temperature"],
        desired_position=columns["desired_position"],
        desired_velocity=columns["desired_velocity"],
        instant_position=answer["position"],
        instant_velocity=answer["velocity"],
        instant_load_position=answer["load_position"],
        torque=answer["torque"],
        load_torque=answer["load_torque"],
        friction_torque=answer["friction_torque"],
        motor_work=answer["motor_work"],
        environment_work=answer["environment_work"],
        friction_work=answer["friction_work"],
    )


def check_positive(name: str, value: float) -> None:
    """Refuse what is not above 0."""
    if not (math.isfinite(value) and value > 0.0):
        raise SpecError(f"{name} {value:g} cannot be: give a number above 0")


def _instants(drive: Drive, seconds: float | None, step: float | Array) -> Array:
    """The times between steps, array [steps + 1]."""
    if isinstance(step, np.ndarray):
        if seconds is not None or step.ndim != 1 or not step.size:
            raise SpecError("with one step after the other given, the seconds follow from them")
        check_positive("step", float(step.min()))
        return np.concatenate([[0.0], np.cumsum(step, dtype=np.float64)])
    check_positive("step", step)
    return step * np.arange(steps_of(drive, seconds, step) + 1, dtype=np.float64)


def steps_of(drive: Drive, seconds: float | None, step: float) -> int:
    """How many steps."""
    if seconds is None:
        if isinstance(drive, Torque) and np.ndim(drive.torque) == 1:
            return np.size(drive.torque)
        if not isinstance(drive, Follow):
            raise SpecError("how long? Give the seconds")
        seconds = drive.trajectory.duration
    check_positive("seconds", seconds)
    count = seconds / step
    if not 0.5 < count <= MOST_STEPS:
        raise SpecError(
            f"{seconds:g} s in steps of {step:g} s are {count:.3g} steps: give 1 to {MOST_STEPS}"
        )
    return round(count)


def _start(drive: Drive, position: float | None, velocity: float | None) -> tuple[float, float]:
    begin = (0.0, 0.0)
    if isinstance(drive, Follow):
        at, speed, _ = drive.trajectory(np.zeros(1))
        begin = (float(at[0]), float(speed[0]))
    start = (begin[0] if position is None else position, begin[1] if velocity is None else velocity)
    if not all(map(math.isfinite, start)):
        raise SpecError("position and velocity at the start must be numbers")
    return start


def _columns(drive: Drive, joint: Joint, instants: Array, start: float) -> dict[str, Array]:
    """What the drive does in each step."""
    begun, length = instants[:-1], np.diff(instants)
    count = begun.size
    names = ("torque", "support", "support_velocity", "desired_position", "desired_velocity")
    columns = {name: np.zeros(count) for name in names}
    columns["time"], columns["dt"] = begun, length
    if isinstance(drive, Torque):
        columns["torque"] = column("torque", drive.torque, count)
    elif isinstance(drive, Pull):
        columns["support"] = start + drive.speed * begun
        columns["support_velocity"] = np.full(count, drive.speed)
    else:
        at, speed, _ = drive.trajectory(begun)
        columns["desired_position"], columns["desired_velocity"] = at, speed
        if drive.feedforward:
            columns["torque"] = _rigid_body(drive, joint, begun + 0.5 * length)
    return columns


def _rigid_body(drive: Follow, joint: Joint, time: Array) -> Array:
    """Torque that inertia and gravity of the desired motion need."""
    at, _, acceleration = drive.trajectory(time)
    gravity = joint.gravity_cos * np.cos(at) + joint.gravity_sin * np.sin(at)
    return joint.total_inertia * acceleration + joint.gravity + gravity


def column(name: str, values: ArrayLike, count: int) -> Array:
    """One number a step, from one or from as many."""
    given = np.asarray(values, dtype=np.float64)
    if given.ndim > 1 or (given.ndim == 1 and given.size != count):
        raise SpecError(f"{name} has {given.size} values for {count} steps: give one a step")
    if not np.isfinite(given).all():
        raise SpecError(f"{name} is not a number everywhere")
    return np.full(count, given) if given.ndim == 0 else np.ascontiguousarray(given)


def _warmth(model: Model, temperature: ArrayLike | None) -> ArrayLike:
    """The temperature, as given or as the model's box has it."""
    if temperature is not None:
        return temperature
    if "temperature" not in model.core.needs:
        return 0.0
    if "temperature" not in model.box:
        raise SpecError(f"{model.spec} depends on the temperature: give it, in degC")
    return 0.5 * sum(model.box["temperature"])


def _sizes(joint: Joint, drive: Drive) -> dict[str, float]:
    tie = (drive.stiffness, drive.damping) if isinstance(drive, Pull) else (0.0, 0.0)
    return {
        "inertia": joint.inertia,
        "gravity": joint.gravity,
        "gravity_cos": joint.gravity_cos,
        "gravity_sin": joint.gravity_sin,
        "stiffness": tie[0],
        "damping": tie[1],
    }


def _apart(joint: Joint) -> dict[str, float] | None:
    return None if joint.transmission is None else vars(joint.transmission)


def _gains(drive: Drive) -> dict[str, float] | None:
    if not isinstance(drive, Follow):
        return None
    return vars(drive.controller)
