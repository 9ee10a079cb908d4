"""Thermometer lag: the thermometer follows the temperature of the contacts late."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Array, Effect, Identified, JointSizes, ResidualView, number
from stribeck.effect.thermal import DESIGN_NOTE, temperature_hardly_varies
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


def _without_temperature(model: Model, _: Recording | Array) -> str | None:
    if "temperature" in model.without_effect("thermometer_lag").core.needs:
        return None
    return (
        f"thermometer_lag corrects the temperature, but friction of {model.spec} does not depend "
        "on it: add temperature_dry or temperature_viscous, or leave the effect out"
    )


def _where(before: Identified, after: Identified) -> str:
    lag, rate = after.model.value("thermometer_lag"), after.recording.temperature_rate
    fastest = 0.0 if rate is None else float(np.max(np.abs(rate)))
    return (
        "friction changes before the temperature shown does, as if the thermometer followed the "
        f"contacts with a time constant of {number(lag)} s: it shows up to "
        f"{number(lag * fastest, 2)} K too little or too much"
    )


def _flexible_shape(fit: Identified) -> list[Array]:
    """Dry and viscous friction that change with the rate of the temperature."""
    rate = fit.recording.temperature_rate
    if rate is None:
        return []
    velocity = fit.recording.velocity[fit.rows]
    return [np.sign(velocity) * rate[fit.rows], velocity * rate[fit.rows]]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"thermometer_lag": 5.0}


EFFECT = Effect(
    id="thermometer_lag",
    view=ResidualView("temperature_rate", along="motion"),
    obstacle=temperature_hardly_varies,
    where=_where,
    plausible=_plausible,
    refusal=_without_temperature,
    flexible_shape=_flexible_shape,
    design_note=DESIGN_NOTE,
    in_motion="measurement",
    cannot_hide=_without_temperature,
    shown_beside="temperature_dry",
)
