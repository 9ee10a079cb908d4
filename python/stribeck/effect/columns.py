"""Columns from which the flexible shapes of effects are built, and the time since a reversal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Powers with which the scale of a torque may change.
SCALE_POWERS = (1.0, 2.0, 4.0, 8.0)


def hats(x: Array, count: int) -> list[Array]:
    """Piecewise-linear functions of `x` over quantile knots, without the constant."""
    knots = np.unique(np.quantile(x, np.linspace(0.0, 1.0, count)))
    if knots.size < 3:
        return []
    unit = np.eye(knots.size)
    return [np.interp(x, knots, row) for row in unit[1:]]


def half_waves(position: Array, harmonics: range) -> list[Array]:
    """Cosines of k half waves over the range of `position`, one for each k of `harmonics`."""
    u = (position - position.min()) / (np.ptp(position) or 1.0)
    return [np.cos(k * np.pi * u) for k in harmonics]


def odd_powers(torque: Array, reference: float) -> list[Array]:
    """Odd functions of a torque that grow faster than it, as a changing torque constant does."""
    ratio = np.abs(torque) / (reference or 1.0)
    return [torque * ratio**power for power in SCALE_POWERS]


def displacement_since_reversal(recording: Recording) -> Array:
    """Distance moved since the direction last changed, array [n] in the unit of position."""
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


def time_since_sign_change(recording: Recording, values: Array) -> Array:
    """Time since `values` [n] last changed their sign, or the segment began, array [n] in s."""
    sign = np.sign(values)
    new = np.concatenate([[True], sign[1:] != sign[:-1]]) | (recording.dt <= 0)
    start = np.maximum.accumulate(np.where(new, np.arange(values.size), 0))
    return np.asarray(recording.elapsed - recording.elapsed[start])


def delayed(recording: Recording, values: Array, delay: float) -> Array:
    """A channel [n] as it was `delay` seconds before; at most back to the start of its segment."""
    start = np.maximum.accumulate(np.where(recording.dt > 0, 0, np.arange(recording.time.size)))
    elapsed = recording.elapsed
    return np.interp(np.maximum(elapsed - delay, elapsed[start]), elapsed, values)
