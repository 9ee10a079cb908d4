"""Motor and link as two bodies: a stiffening torsional spring, or backlash."""

from __future__ import annotations

import math
from typing import Protocol

from stribeck.benchmark.closed_loop.machine import STEP, Machine

#: Integration steps of the two bodies in one controller step.
FINER = 2
#: Resonance of a transmission that is treated as rigid, and of the softest one, rad/s.
STIFF, SOFT = 2 * math.pi * 150.0, 2 * math.pi * 6.0
#: Share of critical damping.
DAMPED = {"stiff": 1.0, "soft": 0.1}


class MotorSide(Protocol):
    """Interface of the motor side."""

    position: float
    velocity: float

    def load_at(self, i: int, position: float | None = None) -> float:
        """Torque of gravity on the link."""

    def step(self, i: int, acting: float, step: float, inertia: float, against: float) -> None:
        """Integrate the motor over one step."""


class Transmission:
    """The link and its connection to the motor.

    Parameters
    ----------
    compliance
        From 0 (rigid) to 1 (softest): ``elasticity``.
    gap
        Angle between the flanks: ``backlash``.
    """

    def __init__(self, machine: Machine, compliance: float, gap: float, start: float) -> None:
        share = machine.motor_share
        self._motor, self._link = share * machine.inertia, (1 - share) * machine.inertia
        reduced = self._motor * self._link / machine.inertia
        softness = 1 / STIFF**2 + compliance * (1 / SOFT**2 - 1 / STIFF**2)
        self._stiffness = reduced / softness
        ratio = DAMPED["soft" if compliance else "stiff"]
        self._damping = 2 * ratio * math.sqrt(self._stiffness * reduced)
        self._gap = gap / 2
        self._bends = 0.5 * machine.vmax / machine.ramp * softness
        self._q, self._v = start, 0.0

    def step(self, i: int, motor: MotorSide, acting: float) -> float:
        """Integrate motor and link over `STEP`; return the mean torque between them."""
        h = STEP / FINER
        carried = 0.0
        for _ in range(FINER):
            torque = self._torque(motor.position - self._q, motor.velocity - self._v)
            motor.step(i, acting, h, self._motor, torque)
            self._v += h / self._link * (torque - motor.load_at(i, self._q))
            self._q += h * self._v
            carried += torque / FINER
        return carried

    def _torque(self, twist: float, rate: float) -> float:
        """Torque of a spring that stiffens with twist; zero within the gap."""
        if self._gap:
            if abs(twist) <= self._gap:
                return 0.0
            pressed = twist - math.copysign(self._gap, twist)
            torque = self._stiffness * pressed + self._damping * rate
            # Flanks can only push.
            return torque if torque * pressed > 0 else 0.0
        stiffer = 1 + (twist / (4 * self._bends)) ** 2
        return self._stiffness * twist * stiffer + self._damping * rate
