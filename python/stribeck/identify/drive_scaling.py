"""Scales and known constants of the motor, from a recording before any fit."""

from __future__ import annotations

from stribeck.models.drive import RESISTANCE, TORQUE_CONSTANT
from stribeck.recording.recording import Recording


def drive_scales(recording: Recording) -> dict[str, float]:
    """The scales of the bounds of the motor's constants.

    ``back_emf`` is the voltage over the largest speed, in V s/rad or V s/m. ``resistance`` is the
    one with which the voltage, at that torque constant, holds the load, in ohm.
    """
    s = recording.scales()
    back_emf = (s["effort"] or 1.0) / (s["speed"] or 1.0)
    return {
        "back_emf": back_emf,
        "resistance": back_emf * (s["effort"] or 1.0) / (s["torque"] or 1.0),
    }


def known_constants(recording: Recording) -> dict[str, float]:
    """Constants of the motor that are given with the recording, at the joint.

    The motor's torque constant kt [N m/A] times the gear ratio; with the motor constant
    km = kt / sqrt(R) [N m/W^0.5] the resistance as well.
    """
    motor = recording.motor
    if recording.drive is None or "kt" not in motor:
        return {}
    known = {TORQUE_CONSTANT: motor["kt"] * motor.get("gear_ratio", 1.0)}
    if "km" in motor:
        known[RESISTANCE] = (motor["kt"] / motor["km"]) ** 2
    return known
