"""Noise of the load torque.

Whatever smooths the load torque lowers the error by the noise that it removes: elasticity does. So
does whatever takes a load torque away that is small beside its noise.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.models.load_noise import load_noise
from stribeck.models.rigid_body import load_torque

#: Load torques, in standard deviations of the noise, below which they count as small.
SIZES = (1.0, 2.0, 4.0, 8.0)


def _columns(fit: Fit) -> list[Array]:
    recording = fit.recording
    load = load_torque(fit.model, recording)
    if load is None:
        return []
    noise = load_noise(recording, load)
    made = [load * np.exp(-((load / (size * noise)) ** 2)) for size in SIZES if noise > 0.0]
    if recording.load_torque is not None and recording.load_torque_smooth is not None:
        made.append(recording.load_torque_smooth - load)
    return [column for column in made if column.any()]


NOISY_LOAD = MeasurementCause("noise of the load torque", _columns)
