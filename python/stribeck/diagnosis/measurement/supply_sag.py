"""Supply that sags with the power that a motor draws, and the gain of its amplifier with it."""

from __future__ import annotations

import numpy as np
import scipy.signal

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit

#: Time constants of a supply, s.
LAGS = (0.0, 0.1, 0.4)


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.averaged:
        return []
    power = np.maximum(fit.prediction * r.velocity, 0.0)
    largest = float(power.max())
    if not largest > 0.0:
        return []
    shares = [1.0 / max(lag * r.rate_hz, 1.0) for lag in LAGS]
    sags = (scipy.signal.lfilter([share], [1.0, share - 1.0], power / largest) for share in shares)
    return [-fit.prediction * sag for sag in sags]


SUPPLY_SAG = MeasurementCause("a supply that sags with the power", _columns, rising=len(LAGS))
