"""A robot in closed loop: every joint follows a motion against its friction, with compensation.

Each step is solved for all joints at once, with friction at its mean velocities: dry friction holds
joints, and laws with a state, such as bristles, are stepped exactly (`src/robot/step`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.checks import check_number
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.models.build import model
from stribeck.models.model import Model
from stribeck.motion.simulate.acting import friction_of
from stribeck.motion.simulate.drive import Controller
from stribeck.robot.arm import Robot
from stribeck.robot.simulate import check_friction, fourier_motion

Array = NDArray[np.float64]

#: Temperature of the joints, degC.
TEMPERATURE = 25.0


@dataclass(frozen=True)
class Followed:
    """One run of a robot in closed loop.

    Attributes
    ----------
    name
        Of the compensation; empty: none.
    position, velocity, torque : arrays [n, N]
        In rad or m of what encoders measure, the joints or their motors, and torque of the
        drives.
    error : array [N]
        RMS of the desired minus the actual position of the joint.
    sticking : array [N]
        Share of the time at which a joint, or its motor where they are coupled, sticks.
    """

    name: str
    position: Array
    velocity: Array
    torque: Array
    error: Array
    sticking: Array


@dataclass(frozen=True, repr=False)
class RobotTracking(Shown):
    """A motion of a robot, followed without and with compensation of friction.

    Attributes
    ----------
    time, desired : arrays [n] and [n, N]
    runs
        Without compensation, then with each of those given.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> friction = {"1": model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)}
    >>> without, known = robot.follow_robot(arm, friction, {"known": friction}, seconds=2.0).runs
    >>> known.name, bool(known.error[0] < 0.1 * without.error[0])
    ('known', True)
    """

    robot: Robot
    time: Array
    desired: Array
    runs: tuple[Followed, ...]

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot simulate --compensate`."""
        rows = [
            {
                "compensation": run.name or None,
                "joints": [
                    {
                        "joint": name,
                        "rms_error": float(run.error[k]),
                        "share_sticking": float(run.sticking[k]),
                    }
                    for k, name in enumerate(self.robot.names)
                ],
            }
            for run in self.runs
        ]
        return {"robot": self.robot.name, "seconds": float(self.time[-1]), "runs": rows}

    def to_frame(self) -> pl.DataFrame:
        """The last run, one row per sample, with the columns of `simulate_robot`."""
        run, made = self.runs[-1], {"time": self.time}
        for k, name in enumerate(self.robot.names):
            made[f"position_{name}"] = run.position[:, k]
            made[f"velocity_{name}"] = run.velocity[:, k]
            made[f"torque_{name}"] = run.torque[:, k]
        return pl.DataFrame(made)


def follow_robot(
    robot: Robot,
    friction: Mapping[str, Model],
    compensations: Mapping[str, Mapping[str, Model]],
    *,
    seconds: float = 10.0,
    rate: float = 1000.0,
    speed: float = 1.0,
    harmonics: int = 5,
    bandwidth: float = 20.0,
    seed: int = 0,
) -> RobotTracking:
    """Follow a random Fourier motion, without compensation of friction and with each one given.

    The controller of a joint is computed torque at the desired motion plus position and velocity
    errors: a critically damped loop of `bandwidth` around its inertia. Compensation is the friction
    of a model at the desired motion.

    Parameters
    ----------
    friction : mapping of Model
        Friction of each joint, with values.
    compensations : mapping
        Friction of each joint as the controller knows it, by a name for tables.
    rate
        Steps per second, Hz.
    bandwidth
        rad/s.

    Raises
    ------
    SpecError
        A joint does not exist; inertia is not known; an effect cannot act in motion.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, robot
    >>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    >>> friction = {
    ...     name: model("coulomb", coulomb_friction=2.0, viscous_friction=1.0) for name in arm.names
    ... }
    >>> found = robot.follow_robot(arm, friction, {"model": friction}, seconds=2.0)
    >>> without, compensated = found.runs
    >>> bool(np.all(compensated.error < without.error))
    True
    """
    check_friction(robot, friction)
    for known in compensations.values():
        check_friction(robot, known)
    check_number("seconds", seconds, 0.1, 600.0, " s")
    check_number("rate", rate, 100.0, 10_000.0, " Hz")
    check_number("speed", speed, 1e-6, 1e3)
    if not 0.0 < bandwidth <= 0.2 * rate:
        raise SpecError(
            f"the bandwidth is {bandwidth:g} rad/s: give a number above 0, at most a fifth of the "
            f"rate, {0.2 * rate:g}"
        )
    time = np.arange(int(seconds * rate)) / rate
    random = np.random.default_rng(seed)
    desired = fourier_motion(time, len(robot.joints), speed, harmonics, random)
    planned = robot.core.of_motors(*desired)
    acting = _acting(robot, friction)
    runs = []
    for name, known in {"": {}, **compensations}.items():
        feedforward = planned[3] + _known(robot, known, time, planned)
        runs.append(
            _run(robot, acting, name, desired[0], planned, feedforward, 1.0 / rate, bandwidth)
        )
    return RobotTracking(robot, time, desired[0], tuple(runs))


def _acting(robot: Robot, friction: Mapping[str, Model]) -> list[Model]:
    """What acts as friction on each motor; nothing where no friction is given."""
    free = model("coulomb", coulomb_friction=0.0, viscous_friction=0.0)
    return [friction_of(friction[name])[0] if name in friction else free for name in robot.names]


def _known(
    robot: Robot, known: Mapping[str, Model], time: Array, planned: Sequence[Array]
) -> Array:
    """Friction of the motors at the desired motion, array [n, N]."""
    position, velocity, acceleration, load = planned
    made = np.zeros_like(load)
    dt = np.diff(time, prepend=time[0])
    for k, joint in enumerate(robot.joints):
        if joint.name in known:
            made[:, k] = friction_of(known[joint.name])[0].torque(
                velocity[:, k],
                position=position[:, k],
                acceleration=acceleration[:, k],
                temperature=TEMPERATURE,
                load_torque=load[:, k],
                dt=dt,
            )
    return made


def _run(
    robot: Robot,
    acting: Sequence[Model],
    name: str,
    desired: Array,
    planned: Sequence[Array],
    feedforward: Array,
    step: float,
    bandwidth: float,
) -> Followed:
    position, velocity = planned[:2]
    gains = [_gains(float(inertia), bandwidth) for inertia in _inertia(robot, desired)]
    columns = {
        "torque": feedforward,
        "temperature": np.full_like(feedforward, TEMPERATURE),
        "desired_position": position,
        "desired_velocity": velocity,
    }
    start = (position[0].tolist(), velocity[0].tolist())
    try:
        made, unsolved = _core.simulate_robot(
            robot.core,
            [model.core for model in acting],
            [model.values for model in acting],
            columns,
            step,
            start,
            gains,
        )
    except _core.ModelError as error:
        raise SpecError(
            f"{robot.name}: the controlled motion diverges: give a lower bandwidth ({error})"
        ) from None
    if unsolved:
        raise SpecError(
            f"{robot.name}: friction and load have no common solution in {unsolved} steps: "
            f"friction of a joint grows as fast as its load, or faster"
        )
    motors, speeds = made["position"][:-1], made["velocity"][:-1]
    joints = robot.joints_of(motors)
    missed = np.sqrt(np.mean((desired - joints) ** 2, axis=0))
    sticking = np.mean(speeds == 0.0, axis=0)
    if robot.encoders == "joints":
        motors, speeds = joints, robot.joints_of(speeds)
    return Followed(name, motors, speeds, made["torque"], missed, sticking)


def _inertia(robot: Robot, desired: Array) -> Array:
    """Mean inertia that each motor sees on a motion [n, N], array [N]."""
    mass = robot.core.mass_matrix(desired)
    turned = robot.motor_torque(np.swapaxes(robot.motor_torque(mass), 1, 2))
    return np.asarray(np.mean(np.diagonal(turned, axis1=1, axis2=2), axis=0))


def _gains(inertia: float, bandwidth: float) -> dict[str, float]:
    """A critically damped loop around an inertia."""
    return asdict(Controller(bandwidth**2 * inertia, derivative=2.0 * bandwidth * inertia))
