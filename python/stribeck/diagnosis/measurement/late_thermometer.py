"""A thermometer on the housing follows the temperature of the contacts late.

Friction at the contacts is that of a temperature which the thermometer shows later: to first order
it differs by the lag times the rate of the temperature shown. That is no alternative to friction
that depends on the temperature, but a part of it. While a joint warms up, that rate falls in
proportion to the temperature, and would explain such friction as well.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    rate = r.temperature_rate
    if r.averaged or rate is None:
        return []
    return [np.sign(r.velocity) * rate, r.velocity * rate]


LATE_THERMOMETER = MeasurementCause("a thermometer that lags", _columns, through="temperature")
