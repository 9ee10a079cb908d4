"""The reference trajectory that the controller of a joint was given."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy

from stribeck.recording.arrays import Floats, floats, floats_or_none
from stribeck.recording.derive import Smoother
from stribeck.recording.joint.channels import Channels
from stribeck.recording.joint.loads import rigid_body_load
from stribeck.recording.naming.names import REFERENCE
from stribeck.recording.recording import Recording
from stribeck.recording.rows import segment_slices
from stribeck.recording.tables.prepared import Prepared

__all__ = ["check_reference", "load_reference", "with_reference"]

_LENGTHS, _ANGLES = ("m", "m/s", "m/s2"), ("rad", "rad/s", "rad/s2")


def load_reference(data: Channels, prepared: Prepared) -> None:
    """Read the reference channels of a table, except for steady-state points.

    A reference that no option names, in a unit of the other kind of joint, is not that of the
    joint: it is left out.
    """
    if prepared.settings.average:
        return
    units = {data.units.get(c) for c in ("position", "velocity", "acceleration")}
    for channel in REFERENCE:
        if channel not in prepared.choices:
            continue
        data.load(channel)
        other = _ANGLES if data.units[channel] in _LENGTHS else _LENGTHS
        named = channel in prepared.settings.maps
        if data.units[channel] and not named and units & set(other):
            _leave_out(data, channel, "is in a unit of another kind of joint")


def check_reference(data: Channels) -> None:
    """Leave out reference channels with missing values."""
    for channel in REFERENCE:
        if channel in data.values and not np.isfinite(data.values[channel]).all():
            _leave_out(data, channel, "has empty, NaN or infinite cells")


def _leave_out(data: Channels, channel: str, why: str) -> None:
    del data.values[channel]
    source = data.prepared.choices[channel].source
    data.notes.append(f"{channel} ('{source}') {why} and is left out")


def with_reference(recording: Recording, data: Channels) -> Recording:
    """The recording with its reference motion, where it has a position or velocity of one.

    What is missing is differentiated or integrated. A reference has no noise, so no filter is used.
    """
    q, v, a = (data.values.get(channel) for channel in REFERENCE)
    if q is None and v is None:
        return recording
    exact = Smoother(recording.time, recording.segment, None)
    if v is None:
        assert q is not None
        v = exact.smooth(q, 1)
    if a is None:
        a = exact.smooth(v, 1)
    if recording.position is None:
        q = None
    elif q is None:
        q = _integrated(recording, recording.position, v)
    load = None
    if "load_torque" not in data.values and "friction_torque" not in data.values:
        load = rigid_body_load(data, q, a, "", smooth=True)
    return replace(
        recording,
        reference_position=floats_or_none(q),
        reference_velocity=floats(v),
        reference_acceleration=floats(a),
        reference_load_torque=floats_or_none(load),
    )


def _integrated(recording: Recording, position: Floats, velocity: Floats) -> Floats:
    """Position of a reference velocity; its mean over each segment is that of the position."""
    made = np.empty_like(position)
    for part in segment_slices(recording.segment):
        x = scipy.integrate.cumulative_trapezoid(velocity[part], recording.time[part], initial=0.0)
        made[part] = x + (position[part].mean() - x.mean())
    return made
