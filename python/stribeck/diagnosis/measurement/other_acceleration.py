"""A load torque of another acceleration than the motion's, as of a reference or behind a filter.

The torque lacks the difference, as far as the measured motion shows it.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.recording.derive import Smoother
from stribeck.recording.mend.load_of_motion import differing, slow_motion
from stribeck.recording.motion.derived_motion import cutoff_of
from stribeck.recording.recording import Recording

#: Least difference, as a share of the load torque.
LEAST = 1e-3


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.load_torque is None or r.acceleration is None or r.averaged:
        return []
    name = "load torque of another acceleration"
    if name not in r.kept:
        r.kept[name] = _lacking(r, r.load_torque, r.acceleration)
    lacking = r.kept[name]
    return [lacking] if rms(lacking[r.moving]) > LEAST * rms(r.load_torque[r.moving]) else []


def _lacking(r: Recording, load: Array, acceleration: Array) -> Array:
    """What the torque lacks of a load torque [n]; zero where that is the motion's."""
    position = r.position if r.joint_kind == "revolute" else None
    slow = slow_motion(r.time, r.velocity, r.segment)
    found = differing(_as_smooth(r, load), acceleration, position, r.moving, slow.smooth)
    return np.zeros_like(load) if found is None else -found.torque


def _as_smooth(r: Recording, load: Array) -> Array:
    """A load torque [n] behind the low-pass of the acceleration."""
    column = r.columns.get("acceleration")
    if column is None or not column.derived:
        return load
    return Smoother(r.time, r.segment, cutoff_of(r)).smooth(load)


OTHER_ACCELERATION = MeasurementCause(
    "a load torque of another acceleration than the motion's",
    _columns,
    rising=1,
    imitates=("elasticity", "backlash", "inertia", "delay"),
)
