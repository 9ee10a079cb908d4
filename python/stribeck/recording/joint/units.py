"""Joint kind and units: what was given, what the units of the columns say, otherwise revolute."""

from __future__ import annotations

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats, floats
from stribeck.recording.joint.channels import Channels
from stribeck.recording.naming.names import REFERENCE
from stribeck.recording.recording import Column, Recording
from stribeck.recording.stated.settings import Mechanics

__all__ = ["current_of", "natural_unit", "settle_units"]

_LINEAR = ("m", "m/s", "m/s2")
_ANGULAR = ("rad", "rad/s", "rad/s2")


def natural_unit(joint_kind: str) -> str:
    """Unit of all loads at a joint."""
    return "N" if joint_kind == "prismatic" else "N m"


def settle_units(data: Channels) -> tuple[str, str, str]:
    """Determine joint kind and units, and convert currents and screws.

    Returns
    -------
    tuple
        Joint kind, unit of torque, unit of position.

    Raises
    ------
    RecordingError
        The units contradict each other, or the joint kind.
    """
    motion = {
        c: data.units[c] for c in ("position", "velocity", "acceleration") if data.units.get(c)
    }
    effort = next(
        (c for c in ("friction_torque", "torque", "current") if c in data.values), "torque"
    )
    turns = [c for c, u in motion.items() if u in _ANGULAR]
    _check_motion(data, motion)
    kind = _kind(data, motion, effort)
    pitch = data.prepared.settings.mechanics.screw_pitch
    per_rad = pitch / (2.0 * np.pi) if kind == "prismatic" and pitch is not None else None
    if turns and per_rad is not None:
        for channel in (*motion, *(c for c in REFERENCE if data.units.get(c) in _ANGULAR)):
            data.values[channel] = data.values[channel] * per_rad
        data.notes.append(f"motion of the screw converted with its pitch of {pitch:g} m per turn")
    unit = data.units.get(effort, "") or natural_unit(kind)
    if effort == "current":
        _current_to_torque(data, natural_unit(kind))
        # The torque constant of a linear motor is in N/A: the product is a force.
        unit = "N" if kind == "prismatic" and per_rad is None else "N m"
    elif effort == "torque" and data.prepared.settings.torque_at == "motor":
        _motor_torque(data)
    if per_rad is not None and unit == "N m":
        for channel in ("torque", "load_torque", "friction_torque"):
            if channel in data.values and data.units.get(channel) != "N":
                data.values[channel] = data.values[channel] / per_rad
        unit = "N"
        data.notes.append(
            f"force = torque of the screw * 2 pi / its pitch of {pitch:g} m per turn (times "
            f"{1.0 / per_rad:.6g})"
        )
    _check_torque(data, kind, effort, unit, screw=per_rad is not None)
    return kind, unit, "m" if kind == "prismatic" else "rad"


def current_of(recording: Recording) -> Floats | None:
    """The current that the torque was computed from, A [n]; None where there was none."""
    origin = recording.origin
    if origin is None or origin.settings.mechanics.torque_constant is None:
        return None
    mechanics = origin.settings.mechanics
    if not any(note.endswith(_conversion(mechanics)) for note in origin.notes):
        return None
    gain = origin.settings.mechanics.torque_constant * mechanics.gear_ratio
    if recording.joint_kind == "prismatic" and mechanics.screw_pitch is not None:
        gain /= mechanics.screw_pitch / (2.0 * np.pi)
    return floats(recording.torque / gain)


def _conversion(mechanics: Mechanics) -> str:
    """How a current becomes a torque, as a note."""
    return (
        f"torque = current * torque constant {mechanics.torque_constant:g} * gear ratio "
        f"{mechanics.gear_ratio:g}"
    )


def _check_motion(data: Channels, motion: dict[str, str]) -> None:
    """Refuse units of motion that contradict each other or the joint kind that was given."""
    lines = [c for c, u in motion.items() if u in _LINEAR]
    turns = [c for c, u in motion.items() if u in _ANGULAR]
    given = data.prepared.settings.joint_kind
    if lines and turns:
        raise RecordingError(
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but {turns[0]} in "
            f"{motion[turns[0]]}: a joint is either prismatic or revolute; correct one with "
            f"{option('unit', 'COLUMN=UNIT')}"
        )
    if given == "revolute" and lines:
        raise RecordingError(
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but the joint is given as "
            f"revolute: give {option('joint_kind', 'prismatic')}, or the column's unit with "
            f"{option('unit', 'COLUMN=UNIT')}"
        )
    if given == "prismatic" and turns and data.prepared.settings.mechanics.screw_pitch is None:
        raise RecordingError(
            f"{data.path}: {turns[0]} is in {motion[turns[0]]} but the joint is given as "
            f"prismatic: give the column's unit with {option('unit', 'COLUMN=UNIT')}, or "
            f"{option('screw_pitch')} (m per turn)"
        )


def _kind(data: Channels, motion: dict[str, str], effort: str) -> str:
    """The joint kind that was given, or what the units say, with a note."""
    given = data.prepared.settings.joint_kind
    if given is not None:
        return given
    for kind, units in (("prismatic", _LINEAR), ("revolute", _ANGULAR)):
        channels = [c for c, u in motion.items() if u in units]
        if channels:
            data.notes.append(f"joint taken as {kind}: {channels[0]} is in {motion[channels[0]]}")
            return kind
    if data.units.get(effort) == "N":
        data.notes.append(f"joint taken as prismatic: {effort} is in N")
        return "prismatic"
    data.notes.append("joint kind not given, taken as revolute")
    return "revolute"


def _current_to_torque(data: Channels, unit: str) -> None:
    """Replace the current by a torque."""
    mechanics = data.prepared.settings.mechanics
    assert mechanics.torque_constant is not None
    gain = mechanics.torque_constant * mechanics.gear_ratio
    torque = data.values.pop("current") * gain
    data.values["torque"] = torque
    choices = data.prepared.choices
    source = f"{choices['current'].source} * {gain:g}"
    data.columns["torque"] = Column.of("torque", source, unit, True, torque)
    data.notes.append(_conversion(mechanics))
    choices.setdefault("torque", choices["current"])


def _motor_torque(data: Channels) -> None:
    """Convert a torque that was stated to be the motor's to the joint, by the gear ratio."""
    ratio = data.prepared.settings.mechanics.motor.get("gear_ratio", 1.0)
    if ratio == 1.0:
        return
    data.values["torque"] = data.values["torque"] * ratio
    data.notes.append(
        f"the torque is the motor's, as stated: at the joint it is times the gear ratio {ratio:g}"
    )


def _check_torque(data: Channels, kind: str, effort: str, unit: str, *, screw: bool) -> None:
    """Refuse a unit of torque that contradicts the joint kind or the load torque."""
    if kind == "prismatic" and unit == "N m":
        raise RecordingError(
            f"{data.path}: the joint is prismatic but {effort} is in N m: give "
            f"{option('screw_pitch')} (m per turn), or {option('unit', 'COLUMN=N')}"
        )
    if kind == "revolute" and unit == "N":
        raise RecordingError(
            f"{data.path}: the joint is revolute but {effort} is in N: give "
            f"{option('joint_kind', 'prismatic')} or {option('unit', 'COLUMN=Nm')}"
        )
    load_unit = data.units.get("load_torque", "")
    same = screw or data.prepared.settings.drive is not None
    if "load_torque" in data.values and load_unit and load_unit != unit and not same:
        raise RecordingError(
            f"{data.path}: load_torque is in {load_unit} but torque in {unit}: give both in one "
            "unit"
        )
