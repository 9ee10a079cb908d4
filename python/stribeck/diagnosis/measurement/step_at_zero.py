"""Step of the torque channel at zero: a dead zone of its sensor, or the dead time of an inverter.

A sensor that shows nothing near zero shows less than the torque beyond. A torque that follows from
a commanded voltage or current is too large by what the inverter loses.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: Half the width of the step, as a share of the RMS torque.
WIDTH = 0.03


def _columns(fit: Fit) -> list[Array]:
    width = WIDTH * rms(fit.prediction[fit.recording.moving])
    return [np.clip(fit.prediction / width, -1.0, 1.0)] if width > 0.0 else []


STEP_AT_ZERO = MeasurementCause("a torque channel with a step at zero", _columns)
