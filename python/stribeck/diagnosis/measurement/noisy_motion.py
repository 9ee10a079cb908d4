"""Noise of the motion in the torque that a model predicts.

An acceleration that is derived, and a noisy velocity, make the prediction noisy. A delay of a
fraction of a sample is read between two samples, and the mean of two samples has less noise than
one: it lowers the error in either direction of the shift.
"""

from __future__ import annotations

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit
from stribeck.recording.rows import neighbour


def _columns(fit: Fit) -> list[Array]:
    if fit.recording.averaged:
        return []
    before, after = (neighbour(fit.prediction, fit.recording.segment, k) for k in (-1, 1))
    return [(before + after) / 2 - fit.prediction]


NOISY_MOTION = MeasurementCause("noise of the motion", _columns, rising=1, imitates=("delay",))
