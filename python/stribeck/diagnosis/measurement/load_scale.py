"""Scale of the load torque: a mass, a lever or a torque constant that is a few percent wrong."""

from __future__ import annotations

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.fitting.result import Fit


def _columns(fit: Fit) -> list[Array]:
    load = fit.recording.load_torque
    return [] if load is None else [load]


LOAD_SCALE = MeasurementCause("a load torque on a wrong scale", _columns)
