"""Test vectors of a robot: random cycles of all joints, and their torques."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError, joint_called
from stribeck.exporters.robot.joints import OF_MOTION, Joints
from stribeck.exporters.vectors import cycles, side, waveform
from stribeck.models.channels import ChannelArguments

Array = NDArray[np.float64]

#: Cycles of a test vector file.
ROWS = 100
#: Range of a sliding joint's position, m.
_SLIDE = (-1.0, 1.0)


@dataclass(frozen=True)
class RobotVectors:
    """Consecutive cycles that start from relaxed friction.

    Attributes
    ----------
    dt : array [n]
        Lengths of the cycles, s.
    channels : dict of array [n, N]
        Position, velocity and acceleration, and what laws read besides.
    torque : array [n, N]
        Torques at the end of each cycle as the core computes them, N m or N.
    """

    dt: Array
    channels: dict[str, Array]
    torque: Array

    @property
    def rows(self) -> list[list[float]]:
        """``dt``, each channel of all joints, all torques: one list a cycle."""
        table = np.column_stack([self.dt, *self.channels.values(), self.torque])
        return [[float(x) for x in row] for row in table]


def robot_vectors(joints: Joints, rows: int = ROWS, seed: int = 0) -> RobotVectors:
    """Cycles of all joints: smooth motion, reversals, rest and jumps.

    Raises
    ------
    SpecError
        The friction of a joint has no torque there.
    """
    random = np.random.default_rng(seed)
    form = np.float32 if joints.precision == "f32" else np.float64
    channels: dict[str, Array] = {}
    for name in (*OF_MOTION[:3], *joints.given):
        columns = [_column(joints, name, k, rows, random) for k in range(joints.count)]
        channels[name] = np.stack(columns, axis=1).astype(form).astype(np.float64)
    if "time" in channels:
        channels["time"][:] = channels["time"][:, :1]
    dt = cycles(rows, random).astype(form).astype(np.float64)
    single = joints.precision == "f32"
    position, velocity, acceleration, load = joints.robot.core.of_motors(
        channels["position"], channels["velocity"], channels["acceleration"], single=single
    )
    moved = {
        "position": position,
        "velocity": velocity,
        "acceleration": acceleration,
        "load_torque": load,
    }
    torque = np.empty_like(load)
    for k in range(joints.count):
        friction = _friction(joints, k, dt, channels | moved)
        torque[:, k] = load[:, k].astype(form) + friction.astype(form)
    if not np.all(np.isfinite(torque)):
        raise SpecError(f"{joints.robot.name} has no finite torque in a motion up to 2 rad/s")
    return RobotVectors(dt, channels, torque)


def _column(
    joints: Joints, channel: str, joint: int, rows: int, random: np.random.Generator
) -> Array:
    slides = joints.robot.joints[joint].movement == "prismatic"
    if channel == "position" and slides:
        return waveform(_SLIDE, rows, random)
    return waveform(side(joints.friction[joint], channel, {}), rows, random)


def _friction(joints: Joints, joint: int, dt: Array, channels: dict[str, Array]) -> Array:
    model, program = joints.friction[joint], joints.programs[joint]
    given: ChannelArguments = {
        name: channels[name][:, joint] for name in program.channels if name != "velocity"
    }
    try:
        torque = model.core.torque(
            model.values,
            dt if model.has_state else None,
            channels["velocity"][:, joint],
            **given,
            single=joints.precision == "f32",
        )
    except ValueError as error:
        name = joints.robot.names[joint]
        raise SpecError(f"{joint_called(name)}, {model.spec}: no test vectors: {error}") from None
    return np.asarray(torque)
