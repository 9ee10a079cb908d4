"""Supply that sags with the power that a motor draws, and the gain of its amplifier with it."""

from __future__ import annotations

import numpy as np

from stribeck.base.low_pass import first_order
from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit

#: Time constants of a supply that does not sag at once, s.
LAGS = (0.1, 0.4)


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.averaged:
        return []
    power = np.maximum(fit.prediction * r.velocity, 0.0)
    largest = float(power.max())
    if not largest > 0.0:
        return []
    drawn = power / largest
    sags = [drawn, *(first_order(drawn, r.dt, lag) for lag in LAGS)]
    return [-fit.prediction * sag for sag in sags]


SUPPLY_SAG = MeasurementCause("a supply that sags with the power", _columns, rising=1 + len(LAGS))
