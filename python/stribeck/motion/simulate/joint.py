"""Joints: inertia, gravity and transmission."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stribeck.base.checks import check_number
from stribeck.base.errors import SpecError


@dataclass(frozen=True)
class Transmission:
    """A spring, a damper and backlash between motor and load.

    Friction and controller act on the motor, and its position is recorded, at the joint side.

    Attributes
    ----------
    motor_inertia
        kg m2 or kg, at the joint side.
    stiffness, damping
        N m/rad, N m s/rad, or N for N m and m for rad; the damper acts while the flanks touch.
    backlash
        Distance between the flanks, rad or m.
    """

    motor_inertia: float
    stiffness: float
    damping: float = 0.0
    backlash: float = 0.0

    def __post_init__(self) -> None:
        for name in ("motor_inertia", "stiffness"):
            _check_positive(f"transmission.{name}", getattr(self, name))
        for name in ("damping", "backlash"):
            check_number(f"transmission.{name}", getattr(self, name), 0.0)


def _check_positive(what: str, value: float) -> None:
    check_number(what, value)
    if not value > 0.0:
        raise SpecError(f"{what} is {value:g}: give one above 0")


@dataclass(frozen=True)
class Joint:
    """A joint of one inertia, or of two with a transmission between them.

    Attributes
    ----------
    inertia
        Inertia or mass, the motor's included unless there is a transmission: kg m2 or kg.
    gravity
        Constant force or torque of gravity, against positive motion: N m or N.
    gravity_cos, gravity_sin
        Gravity of a revolute joint, ``gravity_cos cos q + gravity_sin sin q``: N m.
    kind
        ``"revolute"`` or ``"prismatic"``.
    transmission
        Between motor and load; None: both are one rigid body.

    Examples
    --------
    >>> Joint.ball_screw(mass=11.25, rotor_inertia=1.2298e-5, pitch=6.41e-3).inertia
    23.06...
    """

    inertia: float
    gravity: float = 0.0
    gravity_cos: float = 0.0
    gravity_sin: float = 0.0
    kind: str = "revolute"
    transmission: Transmission | None = None

    def __post_init__(self) -> None:
        for name in ("inertia", "gravity", "gravity_cos", "gravity_sin"):
            check_number(name, getattr(self, name))
        _check_positive("inertia", self.inertia)

    @classmethod
    def revolute(
        cls, inertia: float, *, gravity_cos: float = 0.0, gravity_sin: float = 0.0
    ) -> Joint:
        """A revolute joint: kg m2, N m."""
        return cls(inertia, gravity_cos=gravity_cos, gravity_sin=gravity_sin)

    @classmethod
    def prismatic(cls, mass: float, *, gravity: float = 0.0) -> Joint:
        """A prismatic joint: kg, N."""
        return cls(mass, gravity=gravity, kind="prismatic")

    @classmethod
    def ball_screw(
        cls, mass: float, rotor_inertia: float, pitch: float, *, gravity: float = 0.0
    ) -> Joint:
        """A prismatic joint moved by a ball screw (Gantry, eq 3).

        Parameters
        ----------
        mass : float
            Moved mass, kg.
        rotor_inertia : float
            Inertia of motor and screw, kg m2.
        pitch : float
            Travel per turn, m.
        gravity : float
            Force of gravity along the axis, N.

        Notes
        -----
        ``M_eq = M + J (2 pi/p)^2``; the motor torque times ``2 pi/p`` is the force.
        """
        if not pitch > 0.0:
            raise SpecError(f"the screw's pitch is {pitch:g} m: give one above 0")
        if mass < 0.0 or rotor_inertia < 0.0:
            raise SpecError("mass and rotor inertia of a ball screw cannot be below 0")
        return cls.prismatic(mass + rotor_inertia * (math.tau / pitch) ** 2, gravity=gravity)

    @property
    def motor_inertia(self) -> float:
        """Inertia on which friction acts, kg m2 or kg: the total inertia without a transmission."""
        return self.inertia if self.transmission is None else self.transmission.motor_inertia

    @property
    def total_inertia(self) -> float:
        """Inertia of motor and load, kg m2 or kg."""
        return self.inertia if self.transmission is None else self.inertia + self.motor_inertia

    @property
    def units(self) -> tuple[str, str]:
        """Unit of torque and of position."""
        return ("N m", "rad") if self.kind == "revolute" else ("N", "m")
