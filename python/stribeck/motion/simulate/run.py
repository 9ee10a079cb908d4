"""Simulate a joint with a friction model: open loop, in closed loop, or pulled by a spring."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.arguments import door
from stribeck.base.errors import SpecError
from stribeck.fitting.result import Fit
from stribeck.models.channels import finite
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
from stribeck.motion.simulate.acting import Acting, take_apart
from stribeck.motion.simulate.drive import Drive, Follow, Pull, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.result import Simulation
from stribeck.motion.simulate.temperature import joint_temperature

Array = NDArray[np.float64]

#: Largest number of steps of one simulation; its arrays take 2 GB.
MOST_STEPS = 10_000_000


@door(
    model=WITH_MODEL,
    joint=("a Joint, or None", (Joint, type(None))),
    drive=("a drive: Follow, Torque or Pull", (Torque, Follow, Pull)),
)
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
    """Simulate the motion of a joint with friction.

    Uses the implicit midpoint rule with the exact mean of the friction over each step. It is stable
    for any step, and energy is conserved to rounding. A static law holds the joint exactly at rest.

    Parameters
    ----------
    model : Model, ModelFile or Fit
        Model with values. Its effects on the measurement (delay, gain, saturation) are ignored.
    joint : Joint, optional
        The joint; None: with the inertia and gravity identified together with the friction.
    drive : Torque, Follow or Pull
        What moves the joint.
    seconds : float, optional
        Duration; default: that of the trajectory or of the given torques.
    step : float or array [steps]
        Time step, s; also the sampling time of the controller.
    position, velocity, deflection : float, optional
        Initial state, rad or m and s; default: that of the trajectory, else 0. The deflection is
        that of the bristle.
    temperature : float or array [steps], optional
        degC, where the model depends on it; default: the middle of the operating box of the model.
    external_torque : float or array [steps]
        Positive in the direction of positive motion, N m or N.

    Raises
    ------
    SpecError
        An argument is missing or invalid.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> friction = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> pushed = simulate(friction, Joint.revolute(0.1), Torque(1.9), seconds=60.0)
    >>> float(pushed.position_end)
    0.0
    """
    given = model if isinstance(model, Model) else model.model
    acting = take_apart(given, joint)
    instants = _instants(drive, seconds, step)
    count = instants.size - 1
    start = _start(drive, position, velocity, deflection)
    columns = _columns(drive, acting.joint, instants, start[0])
    columns["temperature"] = column("temperature", joint_temperature(given, temperature), count)
    columns["external"] = column("external torque", external_torque, count)
    return _simulated(given, acting, drive, instants, columns, start)


def _simulated(
    model: Model,
    acting: Acting,
    drive: Drive,
    instants: Array,
    columns: dict[str, Array],
    start: tuple[float, float, float],
) -> Simulation:
    """Run the steps in the core; `start` is position, velocity and deflection."""
    try:
        answer = _core.simulate(
            acting.friction.core,
            acting.friction.values,
            _sizes(acting.joint, drive),
            columns,
            start[:2],
            start[2],
            _gains(drive),
            _transmission(acting.joint),
        )
    except _core.ModelError as error:
        raise SpecError(f"{model.spec} cannot be simulated: {error}") from None
    for name in ("position", "velocity", "torque", "friction_torque"):
        finite(answer[name], f"the simulated {name.replace('_', ' ')} of {model.spec}")
    return Simulation(
        model=model,
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
    """Raise SpecError if `value` is not finite and positive."""
    if not (math.isfinite(value) and value > 0.0):
        raise SpecError(f"{name} {value:g} is invalid: give a number above 0")


def _instants(drive: Drive, seconds: float | None, step: float | Array) -> Array:
    """Return the times between the steps, array [steps + 1]."""
    if isinstance(step, np.ndarray):
        if seconds is not None or step.ndim != 1 or not step.size:
            raise SpecError("each step is given: leave the seconds out")
        check_positive("step", float(step.min()))
        return np.concatenate([[0.0], np.cumsum(step, dtype=np.float64)])
    check_positive("step", step)
    return step * np.arange(steps_of(drive, seconds, step) + 1, dtype=np.float64)


def steps_of(drive: Drive, seconds: float | None, step: float) -> int:
    """Return the number of steps."""
    if seconds is None:
        if isinstance(drive, Torque) and np.ndim(drive.torque) == 1:
            return np.size(drive.torque)
        if not isinstance(drive, Follow):
            raise SpecError("the duration is unknown: give the seconds")
        seconds = drive.trajectory.duration
    check_positive("seconds", seconds)
    count = seconds / step
    if not 0.5 < count <= MOST_STEPS:
        raise SpecError(
            f"{seconds:g} s in steps of {step:g} s are {count:.3g} steps: give 1 to {MOST_STEPS}"
        )
    return round(count)


def _start(
    drive: Drive, position: float | None, velocity: float | None, deflection: float
) -> tuple[float, float, float]:
    """Return initial position, velocity and deflection."""
    begin = (0.0, 0.0)
    if isinstance(drive, Follow):
        at, speed, _ = drive.trajectory(np.zeros(1))
        begin = (float(at[0]), float(speed[0]))
    start = (begin[0] if position is None else position, begin[1] if velocity is None else velocity)
    if not all(map(math.isfinite, start)):
        raise SpecError("initial position and velocity must be finite numbers")
    if not math.isfinite(deflection):
        raise SpecError(f"the initial deflection is {deflection}: give a finite number")
    return (*start, deflection)


def _columns(drive: Drive, joint: Joint, instants: Array, start: float) -> dict[str, Array]:
    """Return the inputs of the drive in each step."""
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
    """Return the torque for inertia and gravity of the desired motion."""
    at, _, acceleration = drive.trajectory(time)
    gravity = joint.gravity_cos * np.cos(at) + joint.gravity_sin * np.sin(at)
    return joint.total_inertia * acceleration + joint.gravity + gravity


def column(name: str, values: ArrayLike, count: int) -> Array:
    """Return an array with one value for each step, from one value or one for each step."""
    given = np.asarray(values, dtype=np.float64)
    if given.ndim > 1 or (given.ndim == 1 and given.size != count):
        raise SpecError(f"{name} has {given.size} values for {count} steps: give one for each step")
    if not np.isfinite(given).all():
        raise SpecError(f"{name} has values that are not finite")
    return np.full(count, given) if given.ndim == 0 else np.ascontiguousarray(given)


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


def _transmission(joint: Joint) -> dict[str, float] | None:
    return None if joint.transmission is None else vars(joint.transmission)


def _gains(drive: Drive) -> dict[str, float] | None:
    if not isinstance(drive, Follow):
        return None
    return vars(drive.controller)
