"""The table of causes in the measurement."""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.diagnosis.measurement.late_channels import LATE_CHANNELS
from stribeck.diagnosis.measurement.late_thermometer import LATE_THERMOMETER
from stribeck.diagnosis.measurement.load_scale import LOAD_SCALE
from stribeck.diagnosis.measurement.warm_up import WARM_UP
from stribeck.fitting.result import Fit

CAUSES: tuple[MeasurementCause, ...] = (WARM_UP, LATE_CHANNELS, LOAD_SCALE, LATE_THERMOMETER)


def measurement_columns(fit: Fit) -> dict[str, Array]:
    """Columns [m, k] of each cause on the samples of a fit, by what the cause is."""
    found = ((cause.what, cause.columns(fit)) for cause in CAUSES)
    return {what: np.column_stack(columns)[fit.rows] for what, columns in found if columns}
