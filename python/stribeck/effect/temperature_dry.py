"""Temperature: dry friction changes with it."""

from __future__ import annotations

import numpy as np

from stribeck.effect.base import Array, Effect, Identified, JointSizes, ResidualView, number
from stribeck.effect.thermal import (
    DESIGN_NOTE,
    cold_and_hot,
    functions_of_temperature,
    generated_temperature,
    one_way,
    reference_temperature,
    temperature_hardly_varies,
)


def _where(before: Identified, after: Identified) -> str:
    m = after.model
    cold, hot, at_cold, at_hot = cold_and_hot(after, "dry")
    more = "higher" if at_cold > at_hot else "lower"
    said = (
        f"dry friction is {number(abs(at_cold - at_hot))} {m.load_unit} {more} at "
        f"{number(cold)} degC than at {number(hot)} degC"
    )
    way = one_way(after.recording)
    if way is None:
        return said
    return f"{said}. The joint only {way}: let it cool down and warm up again to tell it from drift"


def _alike(_: Identified, after: Identified) -> tuple[str, ...]:
    """While a joint only warms up, run-in changes dry friction as the temperature does."""
    return () if one_way(after.recording) is None else ("drift",)


def _flexible_shape(fit: Identified) -> list[Array]:
    """Any function of the temperature."""
    sign = np.sign(fit.recording.velocity[fit.rows])
    return [sign * h for h in functions_of_temperature(fit)]


def _plausible(joint: JointSizes, _: np.random.Generator) -> dict[str, float]:
    return {"temperature_dry_slope": 0.012, "temperature_dry_curvature": 0.01}


EFFECT = Effect(
    id="temperature_dry",
    view=ResidualView("temperature", along="motion"),
    obstacle=temperature_hardly_varies,
    where=_where,
    plausible=_plausible,
    constants=reference_temperature,
    generated_constants=generated_temperature,
    flexible_shape=_flexible_shape,
    alike=_alike,
    design_note=DESIGN_NOTE,
)
