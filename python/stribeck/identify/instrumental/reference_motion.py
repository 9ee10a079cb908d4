"""The motion of a recording as its controller asked for it: free of noise, later by the lag."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.recording import Recording
from stribeck.recording.rows import segment_slices

Array = NDArray[np.float64]

#: Least share of the variance of the velocity that the reference must explain.
LEAST_EXPLAINED = 0.5


def follows(recording: Recording) -> bool:
    """Whether the recording has a reference that its motion follows."""
    v = recording.reference_velocity
    if v is None or not recording.moving.any():
        return False
    late = _delayed(recording, v, lag(recording))
    rows = recording.moving
    measured = recording.velocity[rows]
    return bool(
        np.sum((measured - late[rows]) ** 2) < (1.0 - LEAST_EXPLAINED) * np.sum(measured**2)
    )


def lag(recording: Recording) -> float:
    """Time in s by which the motion follows the reference, by least squares of the velocity.

    It is one number for the whole recording, so noise hardly enters the delayed reference.
    """
    v, a = recording.reference_velocity, recording.reference_acceleration
    assert v is not None and a is not None
    rows = recording.moving
    found = 0.0
    for _ in range(5):
        slope = -_delayed(recording, a, found)[rows]
        apart = recording.velocity[rows] - _delayed(recording, v, found)[rows]
        power = float(np.sum(slope**2))
        if power <= 0.0:
            return 0.0
        found += float(np.sum(slope * apart)) / power
    return found


def _delayed(recording: Recording, values: Array, late: float) -> Array:
    """A channel delayed by `late` seconds within each segment, [n]."""
    made = np.empty_like(values)
    for part in segment_slices(recording.segment):
        t = recording.time[part]
        made[part] = np.interp(t - late, t, values[part])
    return made


def along_reference(recording: Recording) -> Recording:
    """The recording with the reference motion, delayed by the lag, in place of the measured one.

    Torque, temperature and a recorded load torque stay; a load torque of rigid-body terms follows
    the reference.
    """
    late = lag(recording)

    def delayed(values: Array | None) -> Array | None:
        return None if values is None else _delayed(recording, values, late)

    r = recording
    position, velocity = delayed(r.reference_position), delayed(r.reference_velocity)
    acceleration, load = delayed(r.reference_acceleration), delayed(r.reference_load_torque)
    assert velocity is not None and acceleration is not None
    load_smooth = r.load_torque_smooth
    if load is None:
        load = r.load_torque
    else:
        load_smooth = load
    return replace(
        r,
        position=position,
        velocity=velocity,
        acceleration=acceleration,
        load_torque=load,
        position_smooth=position,
        velocity_smooth=velocity,
        acceleration_smooth=acceleration,
        load_torque_smooth=load_smooth,
    )
