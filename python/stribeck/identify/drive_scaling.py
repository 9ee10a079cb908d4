"""What a recording says about the motor before any fit: sizes, and constants that are known."""

from __future__ import annotations

from stribeck.models.drive import RESISTANCE, TORQUE_CONSTANT
from stribeck.recording.recording import Recording


def drive_scales(recording: Recording) -> dict[str, float]:
    """What the bounds of the motor's constants are multiples of.

    ``back_emf`` is the voltage over the largest speed, in V s/rad or V s/m; ``resistance`` the one
    at which the voltage, with that constant, holds the load.
    """
    s = recording.scales()
    back_emf = (s["effort"] or 1.0) / (s["speed"] or 1.0)
    return {
        "back_emf": back_emf,
        "resistance": back_emf * (s["effort"] or 1.0) / (s["torque"] or 1.0),
    }


def known_constants(recording: Recording) -> dict[str, float]:
    """Constants of the motor that were said with the recording, at the joint.

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
