"""The table of causes in the measurement."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stribeck.diagnosis.measurement.cause import Array, MeasurementCause
from stribeck.diagnosis.measurement.late_channels import LATE_CHANNELS
from stribeck.diagnosis.measurement.late_thermometer import LATE_THERMOMETER
from stribeck.diagnosis.measurement.load_scale import LOAD_SCALE
from stribeck.diagnosis.measurement.noisy_load import NOISY_LOAD
from stribeck.diagnosis.measurement.noisy_motion import NOISY_MOTION
from stribeck.diagnosis.measurement.other_acceleration import OTHER_ACCELERATION
from stribeck.diagnosis.measurement.rotor import ROTOR
from stribeck.diagnosis.measurement.step_at_zero import STEP_AT_ZERO
from stribeck.diagnosis.measurement.supply_sag import SUPPLY_SAG
from stribeck.diagnosis.measurement.warm_up import WARM_UP
from stribeck.fitting.result import Fit

CAUSES: tuple[MeasurementCause, ...] = (
    WARM_UP,
    LATE_CHANNELS,
    LOAD_SCALE,
    LATE_THERMOMETER,
    NOISY_LOAD,
    NOISY_MOTION,
    OTHER_ACCELERATION,
    STEP_AT_ZERO,
    SUPPLY_SAG,
    ROTOR,
)


def measurement_columns(fit: Fit) -> dict[str, Array]:
    """Columns [m, k] of each cause on the samples of a fit, by what the cause is."""
    found = ((cause.what, cause.columns(fit)) for cause in CAUSES)
    return {what: np.column_stack(columns)[fit.rows] for what, columns in found if columns}


def without_effect(columns: Mapping[str, Array], effect: str, fit: Fit) -> dict[str, Array]:
    """Those of these columns whose causes act on `fit` without `effect`."""
    acting = {cause.what for cause in CAUSES if cause.acts_without(effect, fit)}
    return {what: made for what, made in columns.items() if what in acting}


def imitating(effect: str) -> list[str]:
    """The causes that look like an effect which is no friction."""
    return [cause.what for cause in CAUSES if effect in cause.imitates]


def least_factors(columns: Mapping[str, Array]) -> Array:
    """The least factor that each of these columns, one after the other, may have [k]."""
    rising = {cause.what: cause.rising for cause in CAUSES}
    made = []
    for what, of_cause in columns.items():
        count = of_cause.shape[1]
        free = count - rising.get(what, 0)
        made.append(np.where(np.arange(count) < free, -np.inf, 0.0))
    return np.concatenate(made)
