"""A robot: a tree of links, each moved by a revolute or prismatic joint."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.robot.coupled import Turns, mixed

Array = NDArray[np.float64]

Movement = Literal["revolute", "prismatic"]
Encoders = Literal["joints", "motors"]

#: The inertial parameters of a link in the order of the regressor's columns: symbol and unit.
PARAMETERS = (
    ("m", "kg"),
    ("mx", "kg m"),
    ("my", "kg m"),
    ("mz", "kg m"),
    ("Ixx", "kg m2"),
    ("Ixy", "kg m2"),
    ("Iyy", "kg m2"),
    ("Ixz", "kg m2"),
    ("Iyz", "kg m2"),
    ("Izz", "kg m2"),
    ("Ir", "kg m2"),
)
#: Standard gravity, m/s2, along -z of the base.
GRAVITY = (0.0, 0.0, -9.80665)


class LinkRow(TypedDict):
    """A link with its joint, in the form of the compiled core."""

    parent: int | None
    prismatic: bool
    axis: list[float]
    rotation: list[list[float]]
    translation: list[float]
    parameters: list[float]
    rotor: float


@dataclass(frozen=True)
class RobotJoint:
    """A joint and the link that it moves.

    Attributes
    ----------
    name
        As recordings and results name the joint.
    movement
        ``"revolute"`` (rad, N m) or ``"prismatic"`` (m, N).
    parent
        Index of the joint that carries it; None: the base.
    axis
        Unit vector along the axis, in the frame of the link.
    rotation, translation
        Frame of the link at position 0 in the frame of the parent: array [3, 3] with its axes as
        columns, and origin [3] in m.
    inertial
        Mass, first moments, and inertia about the origin of the frame (xx, xy, yy, xz, yz, zz),
        array [10]; None: not known.
    rotor
        Inertia of the rotor through the gear, kg m2 or kg.
    drive_gain
        Torque at the joint per motor current, N m/A or N/A; None: torques are recorded. Of a motor
        that turns several joints: torque at one that turns as it does, with the others at rest.
    torque_limit
        Largest torque of the drive, N m or N; None: not known.

    Examples
    --------
    >>> from stribeck import robot
    >>> rows, movements = [{"d": 0.5}, {"a": 0.3}], ["prismatic", "revolute"]
    >>> joints = robot.from_tables("crane", rows, movements=movements).joints
    >>> [(joint.name, joint.parent, joint.torque_unit) for joint in joints]
    [('1', None, 'N'), ('2', 0, 'N m')]
    """

    name: str
    movement: Movement
    parent: int | None
    axis: tuple[float, float, float]
    rotation: Array
    translation: Array
    inertial: Array | None = None
    rotor: float = 0.0
    drive_gain: float | None = None
    torque_limit: float | None = None

    @property
    def torque_unit(self) -> str:
        """``"N m"`` or ``"N"``."""
        return "N m" if self.movement == "revolute" else "N"

    def row(self) -> LinkRow:
        """The joint in the form of the compiled core."""
        inertial = np.zeros(10) if self.inertial is None else self.inertial
        return {
            "parent": self.parent,
            "prismatic": self.movement == "prismatic",
            "axis": [float(x) for x in self.axis],
            "rotation": self.rotation.tolist(),
            "translation": self.translation.tolist(),
            "parameters": inertial.tolist(),
            "rotor": self.rotor,
        }


@dataclass(frozen=True)
class Sphere:
    """A sphere that a link does not leave.

    Attributes
    ----------
    joint
        The joint that moves the link; None: the base.
    centre
        In the frame of the link, m.
    radius
        m.

    Examples
    --------
    >>> from stribeck import robot
    >>> robot.Sphere(None, (0.0, 0.0, 0.2), 0.15).radius
    0.15
    """

    joint: str | None
    centre: tuple[float, float, float]
    radius: float


@dataclass(frozen=True, repr=False)
class Robot(Shown):
    """A robot as it is described, before anything is identified.

    Attributes
    ----------
    joints
        Parents first.
    gravity
        Acceleration of gravity in the frame of the base, m/s2.
    columns
        Column of a recording by channel, with ``{joint}`` and ``{number}`` (from 1) for the joint.
    source
        The file that describes it.
    spheres
        Spheres that the links do not leave, which must not meet.
    coupling
        Velocity of each motor (row) per velocity of each joint; empty: each motor turns its own.
        Torques and friction are then those of the motors.
    encoders
        Of what positions and velocities are recorded.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> still = np.zeros((1, 1))
    >>> arm.names, arm.has_inertia, arm.torque(still, still, still).round(3)
    (('1',), True, array([[5.886]]))
    """

    name: str
    joints: tuple[RobotJoint, ...]
    gravity: tuple[float, float, float] = GRAVITY
    columns: tuple[tuple[str, str], ...] = ()
    source: str = ""
    spheres: tuple[Sphere, ...] = ()
    coupling: Turns = ()
    encoders: Encoders = "joints"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the joints."""
        return tuple(joint.name for joint in self.joints)

    @property
    def has_inertia(self) -> bool:
        """Whether the inertial parameters of every link are known."""
        return all(joint.inertial is not None for joint in self.joints)

    @cached_property
    def core(self) -> _core.RigidBodies:
        """The rigid bodies, in the compiled core."""
        rows = [joint.row() for joint in self.joints]
        return _core.RigidBodies(rows, list(self.gravity), self.coupling or None)

    def joints_of(self, motors: Array) -> Array:
        """Positions, velocities or accelerations of the joints [n, N] from those of the motors."""
        inverse = self.core.joints_per_motor
        return motors if inverse is None else mixed(inverse, motors)

    def motors_of(self, joints: Array) -> Array:
        """Positions, velocities or accelerations of the motors [n, N] from those of the joints."""
        return mixed(self.coupling, joints) if self.coupling else joints

    def motor_torque(self, torque: Array) -> Array:
        """Torques of the motors [n, N, ...] that torques at the joints need.

        Examples
        --------
        >>> from stribeck.robot.tables import from_tables
        >>> wrist = replace(from_tables("wrist", [{}, {}]), coupling=((1.0, 0.0), (1.0, 1.0)))
        >>> wrist.motor_torque(np.array([[3.0, 1.0]]))
        array([[2., 1.]])
        """
        inverse = self.core.joints_per_motor
        return torque if inverse is None else mixed(list(zip(*inverse, strict=True)), torque)

    def with_bodies(
        self, parameters: Array, gravity: tuple[float, float, float] | None = None
    ) -> Robot:
        """The robot with inertial parameters and rotor inertias [N, 11], and another gravity."""
        parameters = np.asarray(parameters, dtype=np.float64)
        if parameters.shape != (len(self.joints), 11):
            raise SpecError(
                f"parameters of {self.name} have shape {list(parameters.shape)}: give ten inertial "
                f"parameters and a rotor inertia for each joint, [{len(self.joints)}, 11]"
            )
        joints = tuple(
            replace(joint, inertial=np.asarray(row[:10]), rotor=float(row[10]))
            for joint, row in zip(self.joints, parameters, strict=True)
        )
        return replace(self, joints=joints, gravity=self.gravity if gravity is None else gravity)

    def regressor(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Derivatives of the torques at the joints by the inertial parameters, array [n, N, 11 N].

        Parameters
        ----------
        position, velocity, acceleration : arrays [n, N]
            In rad or m, and their derivatives.
        """
        return self.core.regressor(*self._samples(position, velocity, acceleration))

    def torque_derivatives(
        self, position: Array, velocity: Array, acceleration: Array
    ) -> tuple[Array, Array, Array]:
        """Derivatives of `torque` by position, velocity and acceleration, arrays [n, N, N].

        One row per torque, one column per joint. The last is the mass matrix. Carpentier and
        Mansard, Robotics: Science and Systems, 2018.

        Examples
        --------
        >>> from stribeck.robot.tables import from_tables
        >>> arm = from_tables("pendulum", [{"a": 0.5, "alpha": 1.5707963267948966}])
        >>> arm = arm.with_bodies(np.array([[2.0, 0, 0, -1.0, 0.5, 0, 0.5, 0, 0, 0, 0.1]]))
        >>> still = np.zeros((1, 1))
        >>> [part.round(3).item() for part in arm.torque_derivatives(still, still, still)]
        [0.0, 0.0, 0.1]
        """
        samples = self._samples(position, velocity, acceleration)
        by_position, by_velocity = self.core.inverse_dynamics_derivatives(*samples)
        return by_position, by_velocity, self.core.mass_matrix(samples[0])

    def torque(self, position: Array, velocity: Array, acceleration: Array) -> Array:
        """Torques or forces at the joints for the rigid bodies, [n, N]: recursive Newton-Euler.

        Examples
        --------
        >>> from stribeck.robot.tables import from_tables
        >>> arm = from_tables("pendulum", [{"a": 0.5, "alpha": 1.5707963267948966}])
        >>> arm.torque(np.zeros((1, 1)), np.zeros((1, 1)), np.ones((1, 1)))
        array([[0.]])
        """
        return self.core.inverse_dynamics(*self._samples(position, velocity, acceleration))

    def _samples(self, *channels: Array) -> tuple[Array, ...]:
        """Positions, velocities and accelerations, checked: arrays [n, N]."""
        given = tuple(np.asarray(channel, dtype=np.float64) for channel in channels)
        rows = given[0].shape[0] if given[0].ndim else 0
        for name, channel in zip(("position", "velocity", "acceleration"), given, strict=True):
            if channel.shape != (rows, len(self.joints)):
                raise SpecError(
                    f"`{name}` has shape {list(channel.shape)}: give one row a sample and one "
                    f"column for each of the {len(self.joints)} joints of {self.name}"
                )
        return given
