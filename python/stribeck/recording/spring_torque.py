"""Torque of the spring of a drive train on which the load oscillates."""

from __future__ import annotations

from stribeck import _core
from stribeck.recording.arrays import Floats
from stribeck.recording.recording import Recording


def spring_torque_curvature(
    recording: Recording, *, period: float = 0.0, damping: float = 0.1
) -> Floats | None:
    """Second derivative of the torque of the spring, N m/s2 or N/s2, [n]; None without a load.

    Parameters
    ----------
    period
        Period of the oscillation without damping, s; 0 where the drive train follows the load
        torque at once.
    damping
        Share of critical damping.
    """
    if recording.load_torque is None or period == 0.0:
        return recording.load_torque_curvature
    return _core.spring_torque_curvature(recording.dt, recording.load_torque, period, damping)
