"""A load torque of another acceleration than the motion's, as of a reference or behind a filter.

The torque lacks the difference, as far as the measured motion shows it.
"""

from __future__ import annotations

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.recording.derive import Smoother
from stribeck.recording.derived_motion import acceleration_cutoff
from stribeck.recording.mend.load_of_motion import differing, slow_cutoff
from stribeck.recording.recording import Recording

#: Least difference, as a share of the load torque.
LEAST = 1e-3


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.load_torque is None or r.acceleration is None or r.averaged:
        return []
    position = r.position if r.joint_kind == "revolute" else None
    slow = Smoother(r.time, r.segment, slow_cutoff(r.time, r.velocity, r.segment))
    load = _as_smooth(r, r.load_torque)
    found = differing(load, r.acceleration, position, r.moving, slow.smooth)
    if found is None or rms(found.torque[r.moving]) < LEAST * rms(r.load_torque[r.moving]):
        return []
    return [-found.torque]


def _as_smooth(r: Recording, load: Array) -> Array:
    """A load torque [n] behind the low-pass of the acceleration."""
    column = r.columns.get("acceleration")
    if column is None or not column.derived:
        return load
    cutoff = acceleration_cutoff(
        r.time, r.velocity, r.segment, r.scales()["sample_period"], r.cutoff_hz
    )
    return Smoother(r.time, r.segment, cutoff).smooth(load)


OTHER_ACCELERATION = MeasurementCause(
    "a load torque of another acceleration than the motion's",
    _columns,
    rising=1,
    imitates=("elasticity", "backlash", "inertia", "delay"),
)
