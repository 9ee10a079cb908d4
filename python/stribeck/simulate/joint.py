"""Joints: what friction, motor and environment act on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stribeck.errors import SpecError


@dataclass(frozen=True)
class Joint:
    """A joint of one inertia.

    Attributes
    ----------
    inertia
        Inertia or mass, the motor's included: kg m2 or kg.
    gravity
        Constant force or torque of gravity, against positive motion: N m or N.
    gravity_cos, gravity_sin
        Gravity of a revolute joint, ``gravity_cos cos q + gravity_sin sin q``: N m.
    kind
        ``"revolute"`` or ``"prismatic"``.

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

    def __post_init__(self) -> None:
        for name in ("inertia", "gravity", "gravity_cos", "gravity_sin"):
            if not math.isfinite(getattr(self, name)):
                raise SpecError(f"the joint's {name} is {getattr(self, name)}: give a number")
        if self.inertia <= 0.0:
            raise SpecError(f"the joint's inertia is {self.inertia:g}: give one above 0")

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
            That is moved, kg.
        rotor_inertia : float
            Of motor and screw, kg m2.
        pitch : float
            Travel a turn, m.
        gravity : float
            Along the axis, N.

        Notes
        -----
        ``M_eq = M + J (2 pi/p)^2``; the motor's torque acts as the force ``2 pi/p`` times it.
        """
        if not pitch > 0.0:
            raise SpecError(f"the screw's pitch is {pitch:g} m: give one above 0")
        if mass < 0.0 or rotor_inertia < 0.0:
            raise SpecError("mass and rotor inertia of a ball screw cannot be below 0")
        return cls.prismatic(mass + rotor_inertia * (math.tau / pitch) ** 2, gravity=gravity)

    @property
    def units(self) -> tuple[str, str]:
        """Unit of torque and of position."""
        return ("N m", "rad") if self.kind == "revolute" else ("N", "m")
