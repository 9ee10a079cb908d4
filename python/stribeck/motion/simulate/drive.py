"""Drives of a simulated joint: a torque, a controller on a trajectory, or a pulled spring."""

from __future__ import annotations

import math
from dataclasses import dataclass

from numpy.typing import ArrayLike

from stribeck.base.errors import SpecError
from stribeck.motion.simulate.trajectory import Trajectory


@dataclass(frozen=True)
class Torque:
    """A given motor torque at the joint side (open loop).

    Attributes
    ----------
    torque
        N m or N, constant over each step: one number, or one per step.
    """

    torque: ArrayLike


@dataclass(frozen=True)
class Controller:
    """A sampled PID position controller; its output is constant over each step.

    Attributes
    ----------
    proportional, integral, derivative
        ``kp e + ki int e dt + kd (b vd - v)``: N m/rad, N m/(rad s), N m s/rad, or N for N m and m
        for rad.
    velocity_weight
        Weight ``b`` of the desired velocity; with 0 the derivative part damps all motion.
    limit
        Largest torque, N m or N; the integral is frozen at the limit.
    """

    proportional: float
    derivative: float = 0.0
    integral: float = 0.0
    velocity_weight: float = 1.0
    limit: float = math.inf

    def __post_init__(self) -> None:
        for name in ("proportional", "derivative", "integral", "velocity_weight"):
            gain = getattr(self, name)
            if not (math.isfinite(gain) and gain >= 0.0):
                raise SpecError(f"the controller's {name} is {gain:g}: give 0 or more")
        if not self.limit > 0.0:
            raise SpecError(f"the controller's limit is {self.limit:g}: give one above 0")

    @classmethod
    def cascade(cls, position_gain: float, velocity_gain: float, **others: float) -> Controller:
        """A position loop around a velocity loop: ``kv (kp (qd - q) - v)``, kp in 1/s."""
        return cls(
            position_gain * velocity_gain, velocity_gain, **{"velocity_weight": 0.0, **others}
        )


@dataclass(frozen=True)
class Follow:
    """A closed loop.

    Attributes
    ----------
    trajectory
        The desired motion.
    controller
        The feedback controller.
    feedforward
        Whether the torque for inertia and gravity of the desired motion is added.
    """

    trajectory: Trajectory
    controller: Controller
    feedforward: bool = False


@dataclass(frozen=True)
class Pull:
    """An initially slack spring with a parallel damper, whose far end moves at constant speed.

    Attributes
    ----------
    stiffness, speed, damping
        N m/rad, rad/s, N m s/rad, or N for N m and m for rad.
    """

    stiffness: float
    speed: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.stiffness) and self.stiffness > 0.0):
            raise SpecError(f"the spring's stiffness is {self.stiffness:g}: give one above 0")
        if not (math.isfinite(self.damping) and self.damping >= 0.0):
            raise SpecError(f"the spring's damping is {self.damping:g}: give 0 or more")
        if not math.isfinite(self.speed):
            raise SpecError(f"the pull's speed is {self.speed}: give a number")


Drive = Torque | Follow | Pull
