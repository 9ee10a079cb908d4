"""A thermometer on the housing follows the temperature of the contacts late.

Friction at the contacts is that of a temperature which the thermometer shows later: to first order
it differs by the lag times the rate of the temperature shown.
"""

from __future__ import annotations

import numpy as np
import scipy

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit

#: Share of the recording over which the temperature is averaged before its rate is taken.
SMOOTHED = 0.04


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.averaged or r.temperature is None:
        return []
    rows = max(int(SMOOTHED * r.rows), 3)
    smooth = scipy.ndimage.uniform_filter1d(r.temperature, rows, mode="nearest")
    rate = np.gradient(smooth)
    rate = scipy.ndimage.uniform_filter1d(rate, rows, mode="nearest")
    return [np.sign(r.velocity) * rate, r.velocity * rate]


LATE_THERMOMETER = MeasurementCause("a thermometer that lags", _columns)
