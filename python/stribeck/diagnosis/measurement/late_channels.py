"""Filters and lags: a channel shows the torque or the motion of other instants.

A filter of the torque channel or of the velocity mixes the torque of neighbouring samples. For
friction, which jumps at reversals, these are free weights of the samples around; for the load,
which is smooth, the first two terms of the series in the lag.
"""

from __future__ import annotations

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause, load_of
from stribeck.fitting.result import Fit
from stribeck.recording.rows import neighbour

#: Largest distance in samples.
REACH = 5


def _columns(fit: Fit) -> list[Array]:
    r = fit.recording
    if r.averaged:
        return []
    load = load_of(fit)
    friction = fit.prediction - load
    distances = (k for k in range(-REACH, REACH + 1) if k)
    made = [neighbour(friction, r.segment, k) - friction for k in distances]

    def difference(values: Array) -> Array:
        return (neighbour(values, r.segment, 1) - neighbour(values, r.segment, -1)) / 2

    rate = difference(load)
    return [*made, rate, difference(rate)]


LATE_CHANNELS = MeasurementCause("a filter or lag of a channel", _columns)
