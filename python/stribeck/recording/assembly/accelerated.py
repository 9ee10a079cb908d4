"""An acceleration that was not recorded, from the position or the velocity."""

from __future__ import annotations

import numpy as np

from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable
from stribeck.recording.arrays import Floats
from stribeck.recording.joint.channels import Channels, Layout
from stribeck.recording.mend.blurred_acceleration import followed_filter
from stribeck.recording.mend.torque_left import torque_of
from stribeck.recording.motion.any_friction import AnyFriction
from stribeck.recording.recording import Column
from stribeck.recording.rows import SIGMAS

__all__ = ["accelerated"]


def accelerated(
    data: Channels,
    layout: Layout,
    known: Derivable,
    velocity: Floats,
    noise: float,
    usual: float | None,
) -> tuple[AccelerationFilter, Floats]:
    """The acceleration [n] and its filter, the one that the torque follows; noted.

    Parameters
    ----------
    velocity, noise
        The velocity, and the standard deviation of its noise: the joint rests where it is slower.
    usual
        The cut-off that follows from the motion, Hz; None: no filter.
    """
    chosen, speed, torque = AccelerationFilter(usual), np.abs(velocity), torque_of(data)
    if torque is None:
        acceleration = chosen.derived(known)
    else:
        friction = AnyFriction(
            velocity,
            float(speed.max()),
            layout.joint_kind == "revolute",
            *(data.values.get(name) for name in ("position", "temperature", "load_torque")),
        )
        moving = speed > SIGMAS * noise
        chosen, acceleration = followed_filter(known, torque, chosen, noise, friction, moving)
    origin = {1: "velocity", 2: "position"}[known.derivative]
    unit = f"{layout.position_unit}/s2"
    data.columns["acceleration"] = Column.of("acceleration", origin, unit, True, acceleration)
    data.notes.append(f"acceleration derived from {origin}, {chosen.text()}")
    return chosen, acceleration
