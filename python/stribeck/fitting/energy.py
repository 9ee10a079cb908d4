"""Electrical energy of a joint's motor: eqs 7-11 of the review of 25 friction models (2024/25).

A brushless motor is modelled as the equivalent DC motor: its power is copper loss plus mechanical
power.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Motor:
    """Constants of a joint's motor and gear.

    Attributes
    ----------
    km
        Motor constant, N m per square root of a watt (N, for a linear motor).
    kb
        Back-EMF constant, V s/rad.
    kt
        Torque constant, N m/A.
    gear_ratio
        Motor turns per joint turn; motor radians per metre for a prismatic joint.
    """

    km: float
    kb: float
    kt: float
    gear_ratio: float


@dataclass(frozen=True)
class Energy:
    """Electrical energy of the measured and of the modelled torque over the same samples, J."""

    measured: float
    modelled: float

    @property
    def error(self) -> float:
        """Measured minus modelled, J (eq 11)."""
        return self.measured - self.modelled

    @property
    def error_percent(self) -> float:
        """The error in per cent of the measured energy; NaN where that is zero."""
        return 100.0 * self.error / self.measured if self.measured else float("nan")

    def to_dict(self) -> dict[str, float]:
        """The contract's JSON."""
        return {
            "measured_J": self.measured,
            "model_J": self.modelled,
            "error_J": self.error,
            "error_percent": self.error_percent,
        }


def joules(energy: Energy | None) -> dict[str, float] | None:
    """The JSON of an energy; None where it is not known."""
    return None if energy is None else energy.to_dict()


def electrical_power(torque: Array, velocity: Array, motor: Motor) -> Array:
    """Electrical power of the motor, W, array [n] (eqs 7 and 8).

    Parameters
    ----------
    torque : array [n]
        Of the motor at the joint side, N m or N.
    velocity : array [n]
        Of the joint, rad/s or m/s.

    Examples
    --------
    >>> motor = Motor(km=0.1, kb=0.12, kt=0.12, gear_ratio=100.0)
    >>> electrical_power(np.array([20.0]), np.array([1.5]), motor)
    array([34.])
    """
    copper = (torque / (motor.gear_ratio * motor.km)) ** 2
    return copper + motor.kb / motor.kt * velocity * torque


def motor_of(recording: Recording) -> Motor | None:
    """The motor of a recording's joint; None if one of its constants is unknown."""
    known: Mapping[str, float] = recording.motor
    if not all(name in known for name in ("km", "kb", "kt", "gear_ratio")):
        return None
    ratio = known["gear_ratio"]
    if recording.joint_kind == "prismatic" and "screw_pitch" in known:
        ratio *= 2.0 * np.pi / known["screw_pitch"]
    return Motor(known["km"], known["kb"], known["kt"], ratio)


def electrical_energy(
    recording: Recording, prediction: Array, rows: NDArray[np.bool_] | None = None
) -> Energy | None:
    """Energy of the measured and of the predicted motor torque over `rows` (eqs 9, 10).

    Parameters
    ----------
    prediction : array [n]
        Predicted motor torque: load torque plus friction.
    rows : bool array [n], optional
        Samples of both sums; the default is those that move. They leave out samples at rest, where
        friction is whatever holds the joint; the review sums over all.

    Returns
    -------
    Energy or None
        None if a motor constant or the gear ratio is unknown, if the effort is not a torque or
        force, if only friction was measured, or for steady-state points, which have no duration.
    """
    motor = motor_of(recording)
    if motor is None or recording.averaged or recording.torque_unit not in ("N m", "N"):
        return None
    if "friction_torque" in recording.columns:
        return None
    rows = recording.moving if rows is None else rows
    step, velocity = recording.dt[rows], recording.velocity[rows]

    def energy(torque: Array) -> float:
        return float(np.sum(electrical_power(torque[rows], velocity, motor) * step))

    return Energy(energy(recording.torque), energy(prediction))


def total_energy(energies: Iterable[Energy | None]) -> Energy | None:
    """Sum over the joints; None if there are none or one of them is unknown."""
    parts = list(energies)
    if not parts or any(part is None for part in parts):
        return None
    known = [part for part in parts if part is not None]
    return Energy(sum(p.measured for p in known), sum(p.modelled for p in known))
