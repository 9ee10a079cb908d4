"""Error figures over scored samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import low_pass
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Segments of so many samples are too short to be filtered.
SHORTEST = 30


def rms(values: Array) -> float:
    """Root mean square; NaN of an empty array."""
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")


def torque_cutoff(recording: Recording) -> float | None:
    """Cut-off frequency of the filtered error in Hz: ten times the bandwidth of the motion.

    The bandwidth holds 99 % of the velocity's power. None where there is nothing to filter:
    steady-state points, or a motion as fast as the sampling.
    """
    if recording.motion_band is None:
        return None
    cutoff = 10.0 * recording.motion_band
    return cutoff if cutoff < 0.4 * recording.rate_hz else None


def zero_phase(recording: Recording, values: Array) -> Array:
    """Zero-phase low-pass at `torque_cutoff`, array [n]; segments too short stay as they are."""
    cutoff = torque_cutoff(recording)
    if cutoff is None:
        return values.copy()
    filtered = values.copy()
    first = np.flatnonzero(np.diff(recording.segment, prepend=-1))
    length = np.diff(first, append=values.size)
    # Segments of equal length are filtered together.
    for size in np.unique(length[length > SHORTEST]):
        rows = first[length == size][:, None] + np.arange(size)
        filtered[rows] = low_pass.zero_phase(values[rows], cutoff, recording.rate_hz)
    return filtered


def bridged(recording: Recording, values: Array) -> Array:
    """`values` [n] of scored samples, joined by straight lines across samples at rest."""
    moving = recording.moving
    if moving.all() or not moving.any():
        return values
    index = np.arange(values.size)
    return np.interp(index, index[moving], values[moving])


def relative_residual(recording: Recording, residual: Array) -> float:
    """Norm of the residual over norm of the torque, both filtered, on scored samples."""
    filtered = zero_phase(recording, bridged(recording, residual))
    torque = zero_phase(recording, recording.torque)
    size = rms(torque[recording.moving])
    return rms(filtered[recording.moving]) / size if size > 0 else float("nan")
