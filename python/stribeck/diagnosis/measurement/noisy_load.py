"""Noise of the load torque.

Whatever smooths the load torque lowers the error by the noise that it removes: elasticity does. So
does whatever takes a load torque away that is small beside its noise.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.models.load_noise import load_noise
from stribeck.models.rigid_body import load_torque
from stribeck.recording.rows import noise_level

#: Load torques, in standard deviations of the noise, below which they count as small.
SIZES = (1.0, 2.0, 4.0, 8.0)
#: Largest noise that a filter removes, in standard deviations of the noise.
MOST_NOISE = 1.5


def _columns(fit: Fit) -> list[Array]:
    recording = fit.recording
    load = load_torque(fit.model, recording)
    if load is None:
        return []
    noise = load_noise(recording, load)
    made = [load * np.exp(-((load / (size * noise)) ** 2)) for size in SIZES if noise > 0.0]
    smooth = recording.load_torque_smooth
    if recording.load_torque is not None and smooth is not None:
        # What a filter removes is noise where it is no larger than the noise of the channel.
        level = noise_level(recording.time, recording.load_torque, recording.segment)
        if rms((smooth - load)[recording.moving]) <= MOST_NOISE * level:
            made.append(smooth - load)
    return [column for column in made if column.any()]


NOISY_LOAD = MeasurementCause(
    "noise of the load torque", _columns, imitates=("elasticity", "backlash")
)
