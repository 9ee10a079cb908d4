"""The load torque of a joint that carries one payload after another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.motion.generate.motion import GeneratedJoint, Motion

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Payloads:
    """Payloads that change while the joint is at rest.

    Attributes
    ----------
    masses : array [swaps + 1]
        Relative to the usual payload.
    rate
        Sample rate, Hz, at which the second derivative of the load is resolved.
    """

    joint: GeneratedJoint
    motion: Motion
    masses: Array
    rate: float

    def torque(self, t: Array, q: Array, a: Array, held_since: Array | None = None) -> Array:
        """Load torque [n] in N m or N at times `t`, with the payload of `held_since` if given."""
        swapped = np.searchsorted(self.motion.swaps, t if held_since is None else held_since)
        revolute = self.joint.kind == "revolute"
        weight = np.cos(q - 0.75 * self.joint.stroke) if revolute else np.ones_like(q)
        return self.joint.gravity * self.masses[swapped] * weight + self.joint.inertia * a

    def external_torque(self, t: Array, q: Array) -> Array:
        """Torque [n] of the environment on the joint: minus the load without acceleration."""
        return -self.torque(t, q, np.zeros_like(q))

    def curvature(self, t: Array) -> Array:
        """Second derivative [n] of the load torque by time, as resolved by samples."""
        before, now, after = (
            self.torque(t + k / self.rate, *self.motion(t + k / self.rate)[::2], held_since=t)
            for k in (-1, 0, 1)
        )
        return np.asarray((before - 2.0 * now + after) * self.rate**2)
