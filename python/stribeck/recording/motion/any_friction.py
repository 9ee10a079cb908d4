"""Columns of a deliberately flexible friction model, to tell what else is in a torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Floats

__all__ = ["AnyFriction"]


@dataclass(frozen=True)
class AnyFriction:
    """What friction and the load of a joint may depend on, arrays [n]; None: not known.

    Attributes
    ----------
    highest_speed
        Speed by which the others are divided.
    revolute
        Whether gravity turns with the position.
    """

    velocity: Floats
    highest_speed: float
    revolute: bool
    position: Floats | None = None
    temperature: Floats | None = None
    load_torque: Floats | None = None

    def columns(self, acceleration: Floats | None) -> list[Floats]:
        """Smooth functions of speed in either direction, of position and temperature, and the load.

        Arrays [n]. The rigid body is among them.
        """
        v, sign = self.velocity, np.sign(self.velocity)
        x = np.abs(v) / (self.highest_speed or 1.0)
        columns = [sign, v, sign * x**0.5, sign * x**2, sign * np.exp(-x / 0.05)]
        columns += [np.abs(sign), x, np.ones_like(v)]
        if acceleration is not None:
            columns.append(acceleration)
        if self.position is not None:
            q = self.position
            span = np.ptp(q) or 1.0
            u = (q - q.min()) / span
            if self.revolute:
                columns += [np.cos(q), np.sin(q)]
            columns += [sign * np.cos(k * np.pi * u) for k in range(1, 5)]
        if self.temperature is not None:
            t = self.temperature - self.temperature.mean()
            columns += [sign * t, v * t]
        load = self.load_torque
        if load is not None:
            columns += [sign * np.abs(load), load]
        return columns
