"""Scale of the torques: a mass that is wrong, or a torque constant that changes with the current.

Both channels may be on a wrong scale: the load torque by a constant factor, the motor torque by one
that grows with its size, as iron saturates and magnets weaken. It does not fall: factors of either
sign would imitate friction that depends on the load.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.effect.columns import SCALE_POWERS, odd_powers
from stribeck.fitting.result import Fit


def _columns(fit: Fit) -> list[Array]:
    load = fit.recording.load_torque
    if load is None:
        return []
    return [load, *odd_powers(fit.prediction, float(np.abs(fit.prediction).max()))]


LOAD_SCALE = MeasurementCause("a torque on a wrong scale", _columns, rising=len(SCALE_POWERS))
