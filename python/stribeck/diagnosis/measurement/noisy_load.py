"""Noise of the load torque, where there is hardly any load torque.

Whatever takes a small load torque away there lowers the error by the noise that it removes.
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
    load = load_torque(fit.model, fit.recording)
    noise = 0.0 if load is None else load_noise(fit.recording, load)
    if load is None or not noise > 0.0:
        return []
    return [load * np.exp(-((load / (size * noise)) ** 2)) for size in SIZES]


NOISY_LOAD = MeasurementCause("noise of the load torque", _columns)
