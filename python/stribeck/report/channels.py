"""The channels that residuals are drawn against, and which of them shows an effect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.base import ResidualView
from stribeck.effect.columns import displacement_since_reversal
from stribeck.effect.registry import find
from stribeck.effect.ripple import ripple_period_of
from stribeck.identify.figures import bridged, zero_phase
from stribeck.recording.motion.spring_torque import Resonance

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Channel:
    """What a residual is drawn against: one value a sample and the axis label."""

    values: Array
    label: str


def view_of(effect: str) -> ResidualView:
    """How an effect shows; one by formula, whose cause is not stated, against velocity."""
    known = find(effect)
    return ResidualView("velocity") if known is None else known.view


def clock(r: Recording) -> Channel:
    """Time for drawing, runs one after another; the velocity for steady-state points."""
    if r.averaged:
        return Channel(r.velocity, f"velocity [{r.position_unit}/s]")
    if r.runs <= 1:
        return Channel(r.time, "time [s]")
    steps = np.diff(r.time, prepend=r.time[0])
    typical = float(np.median(r.dt[r.dt > 0])) if np.any(r.dt > 0) else 1.0
    steps = np.where((np.diff(r.run, prepend=r.run[0]) != 0) | (steps <= 0), typical, steps)
    return Channel(np.cumsum(steps) - steps[0], "time, runs one after another [s]")


def torque_name(unit: str) -> str:
    """Torque, force, or effort where the unit is neither N m nor N."""
    return {"N m": "torque", "N": "force"}.get(unit, "effort")


def channel(fit: Fit, name: str) -> Channel | None:
    """A channel by name; None where the recording has none, or it does not vary."""
    made = _CHANNELS[name](fit)
    if made is None or not np.ptp(made.values[fit.recording.moving]) > 0:
        return None
    return made


def _time(fit: Fit) -> Channel | None:
    return None if fit.recording.averaged else clock(fit.recording)


def _velocity(fit: Fit) -> Channel:
    r = fit.recording
    return Channel(r.velocity, f"velocity [{r.position_unit}/s]")


def _speed(fit: Fit) -> Channel:
    r = fit.recording
    return Channel(np.abs(r.velocity), f"speed |v| [{r.position_unit}/s]")


def _position(fit: Fit) -> Channel | None:
    r = fit.recording
    return None if r.position is None else Channel(r.position, f"position [{r.position_unit}]")


def _phase(fit: Fit) -> Channel | None:
    r = fit.recording
    if r.position is None or "ripple" not in fit.model.effects:
        return None
    period = ripple_period_of(fit.model)
    return Channel(np.mod(r.position, period), f"position within a period [{r.position_unit}]")


def _acceleration(fit: Fit) -> Channel | None:
    r = fit.recording
    if r.averaged:
        return None
    return Channel(r.acceleration_smooth, f"acceleration [{r.position_unit}/s²]")


def _acceleration_along(fit: Fit) -> Channel | None:
    r, made = fit.recording, _acceleration(fit)
    if made is None:
        return None
    return Channel(
        made.values * np.sign(r.velocity),
        f"acceleration · sgn v [{r.position_unit}/s²], below 0: decelerating",
    )


def _temperature(fit: Fit) -> Channel | None:
    r = fit.recording
    return None if r.temperature is None else Channel(r.temperature, "temperature [°C]")


def _temperature_rate(fit: Fit) -> Channel | None:
    rate = fit.recording.temperature_rate
    return None if rate is None else Channel(rate, "rate of the temperature [K/s]")


def _load(fit: Fit) -> Channel | None:
    load, unit = fit.load_torque, fit.model.load_unit
    return None if load is None else Channel(load, f"load {torque_name(unit)} [{unit}]")


def _load_size(fit: Fit) -> Channel | None:
    load, unit = fit.load_torque, fit.model.load_unit
    return None if load is None else Channel(np.abs(load), f"load magnitude [{unit}]")


def _load_along(fit: Fit) -> Channel | None:
    load, unit = fit.load_torque, fit.model.load_unit
    if load is None:
        return None
    return Channel(
        load * np.sign(fit.recording.velocity), f"load · sgn v [{unit}], below 0: the load drives"
    )


def _load_curvature(fit: Fit) -> Channel | None:
    # A model without elasticity has no resonance.
    resonance, unit = Resonance.of(fit.model.core.constants), fit.model.load_unit
    values = resonance.curvature(fit.recording)
    of = "torque in the drive train's spring" if resonance.period > 0.0 else "load"
    return None if values is None else Channel(values, f"second derivative of the {of} [{unit}/s²]")


def _modelled(fit: Fit) -> Channel:
    unit = fit.model.torque_unit
    return Channel(fit.prediction, f"modelled motor {torque_name(unit)} [{unit}]")


def _modelled_rate(fit: Fit) -> Channel | None:
    r, unit = fit.recording, fit.model.torque_unit
    if r.averaged:
        return None
    smooth = zero_phase(r, bridged(r, fit.prediction))
    step = np.where(r.dt > 0, r.dt, np.inf)
    rate = np.diff(smooth, prepend=smooth[:1]) / step
    return Channel(rate, f"rate of the modelled {torque_name(unit)} [{unit}/s]")


def _reversal(fit: Fit) -> Channel | None:
    r = fit.recording
    if r.averaged:
        return None
    way = np.asarray(displacement_since_reversal(r), dtype=np.float64)
    return Channel(way, f"displacement since the last reversal [{r.position_unit}]")


def _load_reversal(fit: Fit) -> Channel | None:
    """Displacement since the load last changed its sign."""
    r, load = fit.recording, fit.load_torque
    if load is None or r.averaged:
        return None
    steps = np.abs(r.velocity) * r.dt
    began = np.concatenate([[True], np.diff(np.sign(load)) != 0]) | (r.dt <= 0)
    start = np.maximum.accumulate(np.where(began, np.arange(load.size), 0))
    way = np.cumsum(steps)
    return Channel(
        way - way[start], f"displacement since the load changed sign [{r.position_unit}]"
    )


_CHANNELS: dict[str, Callable[[Fit], Channel | None]] = {
    "time": _time,
    "velocity": _velocity,
    "speed": _speed,
    "position": _position,
    "phase": _phase,
    "acceleration": _acceleration,
    "acceleration_along": _acceleration_along,
    "temperature": _temperature,
    "temperature_rate": _temperature_rate,
    "load": _load,
    "load_size": _load_size,
    "load_along": _load_along,
    "load_curvature": _load_curvature,
    "modelled": _modelled,
    "modelled_rate": _modelled_rate,
    "reversal": _reversal,
    "load_reversal": _load_reversal,
}
