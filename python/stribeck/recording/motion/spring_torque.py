"""Torque of the spring of a drive train on which the load oscillates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

from stribeck import _core
from stribeck.recording.arrays import Floats
from stribeck.recording.recording import Recording

#: What the names of these quantities begin with among the constants of a model.
PREFIX = "resonance_"


@dataclass(frozen=True)
class Resonance:
    """An oscillation of the load on the spring of a drive train.

    Attributes
    ----------
    period : float
        Period without damping, s; 0 where the drive train follows the load torque at once.
    damping : float
        Share of critical damping.
    hardening : float
        Torque at which the spring carries twice that of a linear one; 0 for a linear spring.
    motor_inertia : float
        Part of the inertia of the load torque that does not oscillate, kg m2 or kg.
    """

    period: float = 0.0
    damping: float = 0.1
    hardening: float = 0.0
    motor_inertia: float = 0.0

    @classmethod
    def of(cls, constants: Mapping[str, float]) -> Resonance:
        """The resonance that the constants of a model state."""
        names = {field.name: PREFIX + field.name for field in fields(cls)}
        return cls(**{name: constants[of] for name, of in names.items() if of in constants})

    @property
    def constants(self) -> dict[str, float]:
        """It as constants of a model."""
        return {PREFIX + field.name: getattr(self, field.name) for field in fields(self)}

    def curvature(self, recording: Recording) -> Floats | None:
        """Second derivative of the torque of the spring, N m/s2 or N/s2, [n]; None without a load.

        For a spring that hardens it is that of the linear part of its torque.
        """
        if recording.load_torque is None or self.period == 0.0:
            return recording.load_torque_curvature
        load = recording.load_torque
        if self.motor_inertia and recording.acceleration is not None:
            load = load - self.motor_inertia * recording.acceleration
        hardening = self.hardening or None
        return _core.spring_torque_curvature(
            recording.dt, load, self.period, self.damping, hardening
        )
