"""A second encoder, on the shaft of the motor."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.arrays import Floats, floats
from stribeck.recording.joint.channels import Channels
from stribeck.recording.naming.names import MOTOR
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import segment_slices
from stribeck.recording.tables.prepared import Prepared

__all__ = ["check_motor", "load_motor", "with_motor"]

#: A measured ratio of both encoders within this share of the known one confirms it.
_NEAR = 0.02
#: A joint that moves less than this share of its motor's motion is held.
_STILL = 0.2


def load_motor(data: Channels, prepared: Prepared) -> None:
    """Read the channels of the motor's encoder, except for steady-state points."""
    if prepared.settings.average:
        return
    for channel in MOTOR:
        if channel in prepared.choices:
            data.load(channel)


def check_motor(data: Channels) -> None:
    """Leave out channels of the motor with missing values."""
    for channel in MOTOR:
        if channel in data.values and not np.isfinite(data.values[channel]).all():
            _leave_out(data, channel, "has empty, NaN or infinite cells and is left out")


def _leave_out(data: Channels, channel: str, why: str) -> None:
    del data.values[channel]
    data.columns.pop(channel, None)
    data.notes.append(f"{channel} ('{data.prepared.choices[channel].source}') {why}")


def with_motor(recording: Recording, data: Channels) -> Recording:
    """The recording with the motion of the motor at the joint side.

    It is divided by the gear ratio, or taken as it is where the drive has divided it already: the
    motion of the joint tells which. If it tells neither, the channel is left out with a note.
    """
    of_joint = {"motor_position": recording.position, "motor_velocity": recording.velocity}
    made: dict[str, Floats] = {}
    for channel in MOTOR:
        own, joint = data.values.get(channel), of_joint[channel]
        if own is None:
            continue
        if joint is None:
            _leave_out(data, channel, "is left out: there is no position of the joint beside it")
            continue
        ratio = _held(data, channel, own, joint)
        if ratio is None:
            ratio = _confirmed(recording, data, channel, _measured(recording, own, joint))
        if ratio is None:
            continue
        made[channel] = floats(own / ratio)
        unit = recording.position_unit + ("/s" if channel == "motor_velocity" else "")
        source = data.prepared.choices[channel].source
        data.columns[channel] = Column.of(channel, source, unit, ratio != 1.0, made[channel])
    return replace(recording, notes=tuple(data.notes), **made)  # type: ignore[arg-type]


def _held(data: Channels, channel: str, own: Floats, joint: Floats) -> float | None:
    """The given gear ratio, where the motor alone moves and cannot confirm it; None otherwise."""
    ratio = data.prepared.settings.mechanics.motor.get("gear_ratio")
    if ratio is None or np.ptp(joint) > _STILL * np.ptp(own) / abs(ratio):
        return None
    data.notes.append(f"{channel} is divided by {ratio:.6g}, as given: the joint is held")
    return ratio


def _measured(recording: Recording, own: Floats, joint: Floats) -> float:
    """How many times the motion of the joint that of the motor is, by least squares."""
    both = power = 0.0
    for part in segment_slices(recording.segment):
        x = joint[part] - joint[part].mean()
        both += float(x @ own[part])
        power += float(x @ x)
    return both / power if power > 0.0 else math.nan


def _confirmed(recording: Recording, data: Channels, channel: str, measured: float) -> float | None:
    """The known ratio that the measured one agrees with; None, with a note, if there is none."""
    mechanics = data.prepared.settings.mechanics
    ratio = mechanics.motor.get("gear_ratio", 1.0)
    known = [ratio, 1.0]
    if recording.joint_kind == "prismatic" and mechanics.screw_pitch is not None:
        known.insert(0, ratio * 2.0 * math.pi / mechanics.screw_pitch)
    for one in known:
        if abs(measured / one - 1.0) < _NEAR:
            text = f"divided by {one:.6g}" if one != 1.0 else "at the joint side as recorded"
            data.notes.append(f"{channel} is {text} (both encoders: {measured / one:.5f} times)")
            return one
    _leave_out(
        data,
        channel,
        f"moves {measured:.6g} times as far as the joint and is left out: give its unit with "
        f"{option('unit', 'COLUMN=UNIT')} and {option('gear_ratio', round(measured, 3))}",
    )
    return None
