"""Error figures over scored rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from stribeck.recording import Recording

Array = NDArray[np.float64]


def rms(values: Array) -> float:
    """Root mean square; NaN of nothing."""
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")


def zero_phase(recording: Recording, values: Array) -> Array:
    """Low-pass without phase at the recording's cut-off; segments too short stay as they are."""
    if recording.cutoff_hz is None or recording.rate_hz <= 2.2 * recording.cutoff_hz:
        return values.copy()
    filtered = values.copy()
    sos = butter(4, recording.cutoff_hz, fs=recording.rate_hz, output="sos")
    edges = np.flatnonzero(np.diff(recording.segment)) + 1
    for piece in np.split(np.arange(values.size), edges):
        if piece.size > 30:
            filtered[piece] = sosfiltfilt(sos, values[piece])
    return filtered


def bridged(recording: Recording, values: Array) -> Array:
    """`values` on scored rows, joined by straight lines across the rows at rest."""
    moving = recording.moving
    if moving.all() or not moving.any():
        return values
    index = np.arange(values.size)
    return np.interp(index, index[moving], values[moving])


def relative_residual(recording: Recording, residual: Array) -> float:
    """Norm of the residual over norm of the torque, both filtered, on scored rows."""
    filtered = zero_phase(recording, bridged(recording, residual))
    torque = zero_phase(recording, recording.torque)
    size = rms(torque[recording.moving])
    return rms(filtered[recording.moving]) / size if size > 0 else float("nan")
