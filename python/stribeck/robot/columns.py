"""Columns of the torque balance that belong to the rigid bodies, and to causes beside them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import joint_called
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.motion import RobotMotion

Array = NDArray[np.float64]

#: Powers of the position in the torque of a spring.
SPRING_TERMS = 3


@dataclass(frozen=True, eq=False)
class Cause:
    """Something beside the rigid bodies of the robot that loads its joints.

    Attributes
    ----------
    id
        ``"payload"``, ``"spring"``, ``"tilt"``, ``"coupling"`` or ``"transmission"``.
    text
        What it is, without full stop.
    runs
        Of a payload: the runs that carry it.
    columns : array [n, N, k]
        Torques of the motors per unit of each of its parameters.
    """

    id: str
    text: str
    motion: RobotMotion
    columns: Array
    runs: tuple[str, ...] = ()

    @property
    def count(self) -> int:
        """Number of its parameters."""
        return int(self.columns.shape[2])

    @cached_property
    def filtered(self) -> tuple[Array, ...]:
        """The columns of each joint after the low-pass, at its scored samples."""
        return _filtered(self.motion, self.columns)


@dataclass(frozen=True, eq=False)
class RigidColumns:
    """The regressor of the base parameters on a motion."""

    motion: RobotMotion
    base: BaseParameters

    @cached_property
    def values(self) -> Array:
        """Array [n, N, b]."""
        return self.motion.regressor(self.base.chosen)

    @cached_property
    def filtered(self) -> tuple[Array, ...]:
        """Of each joint after the low-pass, at its scored samples."""
        return _filtered(self.motion, self.values)


def _filtered(motion: RobotMotion, columns: Array) -> tuple[Array, ...]:
    return tuple(
        motion.filtered(columns[:, j], j)[motion.scored[:, j]] for j in range(columns.shape[1])
    )


def payload(motion: RobotMotion, runs: tuple[str, ...]) -> Cause:
    """A payload on the last link in some runs: its ten inertial parameters."""
    first = motion.joints[0]
    among = [k for k, name in enumerate(first.run_names) if name in runs]
    carried = np.isin(first.run, among)
    last = 11 * (len(motion.joints) - 1)
    columns = motion.regressor(np.arange(last, last + 10)) * carried[:, None, None]
    others = [name for name in first.run_names if name not in runs]
    text = f"a payload in {', '.join(runs)}"
    if len(first.run_names) == 2:
        text += f", or one fewer than in {others[0]}"
    return Cause("payload", text, motion, columns, runs)


def spring(motion: RobotMotion, joint: int) -> Cause:
    """A spring between a joint and its carrier, such as a balancer or a cable.

    Cables stiffen and balancers turn about points beside the axis, so the torque is a smooth
    function of the position: a cubic.
    """
    position = motion.position[:, joint]
    middle = 0.5 * (position.min() + position.max())
    part = (position - middle) / max(np.ptp(position) / 2.0, 1e-9)
    columns = np.zeros((*motion.position.shape, SPRING_TERMS))
    columns[:, joint] = part[:, None] ** np.arange(1, SPRING_TERMS + 1)
    name = motion.robot.names[joint]
    text = f"a spring, balancer or cable at {joint_called(name)}"
    return Cause("spring", text, motion, motion.robot.motor_torque(columns))


def coupling(motion: RobotMotion, first: int, second: int) -> Cause:
    """A rotor that two joints turn through their gears, as in wrists."""
    columns = np.zeros((*motion.position.shape, 1))
    columns[:, first, 0] = motion.acceleration[:, second]
    columns[:, second, 0] = motion.acceleration[:, first]
    names = motion.robot.names
    text = f"a rotor that joints {names[first]} and {names[second]} turn together"
    return Cause("coupling", text, motion, motion.robot.motor_torque(columns))


def transmission(motion: RobotMotion, torque: Array, motor: int, other: int, turns: float) -> Cause:
    """A motor that turns with the joint of another one, whose motor it loads.

    Its friction then has another velocity: columns of the dry and the viscous part of that change.

    Parameters
    ----------
    torque : array [n]
        Modelled torque of the motor.
    motor, other
        Numbers of the motor, and of the motor of the joint.
    turns
        About how far it turns with it, in its turns.
    """
    columns = np.zeros((*motion.position.shape, 3))
    columns[:, other, 0] = -torque
    columns[:, motor, 1:] = turned_friction(motion, motor, other, turns)
    names = motion.robot.names
    than = "otherwise than stated" if motion.robot.coupling else "too"
    text = (
        f"the motor of {joint_called(names[motor])} turns with {joint_called(names[other])} {than}"
    )
    return Cause("transmission", text, motion, columns)


def turned_friction(motion: RobotMotion, motor: int, other: int, turns: float) -> Array:
    """Changes of dry and viscous friction of a motor that turns with another, array [n, 2]."""
    velocity = motion.robot.motors_of(motion.velocity)
    own, more = velocity[:, motor], velocity[:, other]
    return np.column_stack([np.sign(own + turns * more) - np.sign(own), more])


def tilt(motion: RobotMotion, parameters: Array) -> Cause:
    """A base that is not level: gravity along x and y of the base.

    Parameters
    ----------
    parameters : array [N, 11]
        Inertial parameters of the links.
    """
    parts = [
        motion.robot.with_bodies(parameters, gravity).core.gravity_torque(motion.position)
        for gravity in ((9.81, 0.0, 0.0), (0.0, 9.81, 0.0))
    ]
    columns = motion.robot.motor_torque(np.stack(parts, axis=2))
    return Cause("tilt", "a base that is not level", motion, columns)
