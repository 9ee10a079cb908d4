"""Warm-up of an amplifier: gain and zero of the torque channel settle exponentially."""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit

#: Duration of the recording in time constants, from hardly settled to settled early.
RATES = (0.5, 3.0, 10.0)


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.averaged:
        return []
    share = r.elapsed / (float(r.elapsed[-1]) or 1.0)
    left = [np.exp(-rate * share) for rate in RATES]
    return [*left, *(p * fit.prediction for p in left)]


WARM_UP = MeasurementCause("an amplifier whose gain and zero settle during the recording", _columns)
