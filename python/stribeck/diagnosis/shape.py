"""The most flexible form of an effect, as columns that only a diagnosis uses.

Before a second cause is claimed, the causes already in the model get these: what they remove
was the first cause's shape, not another cause.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.result import Fit
from stribeck.identify.periodogram import FEWEST_PERIODS
from stribeck.models.model import Model
from stribeck.recording.derive import Smoother
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


def hats(x: Array, count: int) -> list[Array]:
    """Piecewise-linear functions of x over quantile knots, without the constant."""
    knots = np.unique(np.quantile(x, np.linspace(0.0, 1.0, count)))
    if knots.size < 3:
        return []
    rows = np.eye(knots.size)
    return [np.interp(x, knots, row) for row in rows[1:]]


def waves(position: Array, harmonics: range) -> list[Array]:
    """Half waves over the stroke that `position` covers, one for each of `harmonics`."""
    u = (position - position.min()) / (np.ptp(position) or 1.0)
    return [np.cos(k * np.pi * u) for k in harmonics]


def powers(torque: Array, reference: float) -> list[Array]:
    """Odd functions of a torque that bend ever later: a wrong torque constant at high torque."""
    ratio = np.abs(torque) / (reference or 1.0)
    return [torque * ratio**power for power in (1.0, 2.0, 4.0, 8.0)]


def displacement_since_reversal(recording: Recording) -> Array:
    """Distance moved since the direction last changed, every row, in the unit of position."""
    v = np.where(recording.moving, recording.velocity, 0.0)
    sign = np.sign(v)
    index = np.arange(v.size)
    last = np.maximum.accumulate(np.where(sign != 0, index, 0))
    direction = sign[last]
    new = np.concatenate([[True], direction[1:] != direction[:-1]])
    new |= recording.dt <= 0
    start = np.maximum.accumulate(np.where(new, index, 0))
    travel = np.cumsum(np.abs(v) * recording.dt)
    return np.asarray(travel - travel[start])


def ripple_period_of(model: Model) -> float:
    """Period of the fitted ripple, in the unit of position."""
    constants = model.constants
    detuning = model.value("ripple_detuning") / constants["position_length"]
    return 1.0 / (1.0 / constants["ripple_period"] + detuning)


def _earlier(r: Recording, values: Array, delay: float) -> Array:
    """A channel as it was `delay` seconds before, [n]; at most to the start of its segment."""
    start = np.maximum.accumulate(np.where(r.dt > 0, 0, np.arange(r.time.size)))
    return np.interp(np.maximum(r.elapsed - delay, r.elapsed[start]), r.elapsed, values)


def time_since_reversal(recording: Recording, load: Array) -> Array:
    """Time since the load torque last changed its sign, or the segment began, [n] in s."""
    sign = np.sign(load)
    new = np.concatenate([[True], sign[1:] != sign[:-1]]) | (recording.dt <= 0)
    start = np.maximum.accumulate(np.where(new, np.arange(load.size), 0))
    return np.asarray(recording.elapsed - recording.elapsed[start])


def flexible_columns(fit: Fit) -> Array:
    """Columns [m, k] that let the effects of `fit` take any smooth form, on its rows."""
    r, rows = fit.recording, fit.rows
    v = r.velocity[rows]
    sign = np.sign(v)
    speed = np.abs(v) / (r.scales()["speed"] or 1.0)
    columns: list[Array] = []
    for effect in fit.model.effects:
        columns += _columns(effect, fit, v, sign, speed)
    if not columns:
        return np.empty((rows.size, 0))
    return np.column_stack(columns)


def _columns(effect: str, fit: Fit, v: Array, sign: Array, speed: Array) -> list[Array]:
    r, rows = fit.recording, fit.rows
    if effect == "stribeck":
        slow = fit.model.value("stribeck_velocity")
        return [sign * np.exp(-np.abs(v) / (slow * k)) for k in (0.3, 1.0, 3.0)]
    if effect == "frictional_lag" and fit.model.has("stribeck"):
        return _late_curves(fit, sign)
    if effect == "backlash":
        return _after_reversals(fit)
    if effect == "elasticity":
        return _of_the_twist(fit)
    if effect == "nonlinear_viscous":
        return [sign * speed**power for power in (0.5, 1.5, 2.0, 3.0)]
    if effect == "load":
        load = r.load_torque if r.load_torque is not None else fit.load
        return [] if load is None else [sign * h for h in hats(np.abs(load[rows]), 7)]
    if effect in ("temperature_dry", "temperature_viscous") and r.temperature is not None:
        by = sign if effect == "temperature_dry" else v
        return [by * h for h in hats(r.temperature[rows], 6)]
    if effect == "position" and r.position is not None:
        return [sign * wave for wave in waves(r.position[rows], range(1, 15))]
    if effect == "spring" and r.position is not None:
        # Slower than a ripple; with a constant, for nobody knows where the spring is at rest.
        return waves(r.position[rows], range(2 * FEWEST_PERIODS))
    if effect == "ripple" and r.position is not None:
        phase = 2.0 * np.pi * r.position[rows] / ripple_period_of(fit.model)
        return [wave(k * phase) for k in (3, 4) for wave in (np.cos, np.sin)]
    if effect == "drift":
        return [sign * h for h in hats(r.elapsed[rows], 6)]
    if effect == "saturation":
        return powers(fit.prediction[rows], fit.model.constants["reference_torque"])
    if effect == "presliding":
        travel = displacement_since_reversal(r)[rows]
        return [sign * h for h in hats(np.log(travel + 1e-9 * (travel.max() or 1.0)), 8)]
    if effect == "direction":
        return [speed**power for power in (0.5, 2.0, 3.0)]
    return []


def _late_curves(fit: Fit, sign: Array) -> list[Array]:
    """What the Stribeck curve was at some times before: any way of following the speed late."""
    r = fit.recording
    lag = fit.model.value("frictional_lag")
    speed = np.abs(r.denoised("velocity"))
    slow = _slow_speed(fit)
    return [
        sign * np.exp(-_earlier(r, speed, lag * k)[fit.rows] / (slow * width))
        for k in (0.3, 1.0, 2.0)
        for width in (0.5, 1.5)
    ]


def _slow_speed(fit: Fit) -> float:
    """Speed at which the Stribeck curve has fallen, of the law's or the effect's."""
    names = fit.model.names
    name = next((n for n in names if n.endswith("stribeck_velocity")), None)
    return 0.1 * fit.recording.scales()["speed"] if name is None else abs(fit.model.value(name))


def _after_reversals(fit: Fit) -> list[Array]:
    """The load and its change by the time since it reversed: any way in which a gap closes."""
    r = fit.recording
    load = r.load_torque if r.load_torque is not None else fit.load
    if load is None:
        return []
    since = time_since_reversal(r, load)
    speed = fit.model.constants["reference_velocity"]
    closing = 4.0 * fit.model.value("backlash_gap") / speed
    near = np.exp(-((since / closing) ** 2))[fit.rows]
    early = hats(np.minimum(since[fit.rows] / closing, 2.0), 6)
    change = np.gradient(load)[fit.rows]
    return [near * x for x in (load[fit.rows], change)] + [
        x * h * near for x in (load[fit.rows], change) for h in early
    ]


def _of_the_twist(fit: Fit) -> list[Array]:
    """Its damping, and the share of the motor's inertia in what the spring carries."""
    r = fit.recording
    if r.load_torque is None:
        return []
    smoother = Smoother(r.time, r.segment, None)
    damping = smoother.smooth(r.denoised("load_torque"), 1)
    motor = smoother.smooth(r.acceleration_smooth, 2)
    return [damping[fit.rows], motor[fit.rows]]
