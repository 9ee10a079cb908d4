"""Period of a ripple: the strongest line in the spectrum of a residual over position.

A ripple repeats in position, not in time. A magnet, a tooth, a pole of the motor or a turn of the
screw leaves a line in the spectrum over position, at any speed and gear ratio.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Fewest periods along the stroke: fewer are a shape along it, not a ripple.
FEWEST_PERIODS = 3
#: Fewest samples per period at the median speed.
FEWEST_SAMPLES = 4
#: Most periods along the stroke that are searched.
MOST_PERIODS = 2000
#: Frequencies searched per period along the stroke.
FINENESS = 4
#: A line at half the frequency with this share of the power is the fundamental.
SHARE_OF_FUNDAMENTAL = 0.05


def most_periods(recording: Recording) -> int:
    """The most periods along the stroke that the samples resolve."""
    if recording.position is None or recording.averaged:
        return 0
    moving = recording.moving
    if not moving.any():
        return 0
    stroke = float(np.ptp(recording.position[moving]))
    step = float(np.median(np.abs(recording.velocity[moving]))) / recording.rate_hz
    return min(int(stroke / (FEWEST_SAMPLES * step)), MOST_PERIODS)


def strongest_period(recording: Recording, residual: Array | None = None) -> float:
    """Period of the strongest line in the spectrum of `residual` over position.

    Parameters
    ----------
    residual : array [n]
        Residual of a model; default: of Coulomb and viscous friction with a rigid body.

    Returns
    -------
    float
        In the unit of position; the whole stroke where no period can be identified.
    """
    assert recording.position is not None
    q = recording.position[recording.moving]
    stroke = float(np.ptp(q)) or 1.0
    highest = most_periods(recording)
    if highest <= FEWEST_PERIODS:
        return stroke
    rest = (_plain_residual(recording) if residual is None else residual)[recording.moving]
    along = (q - q.min()) / stroke
    rest = _without_trend(recording, along, rest)
    cells = FINENESS * highest * 4
    sums = np.bincount(np.minimum((along * cells).astype(np.intp), cells - 1), rest, cells)
    power = np.abs(np.fft.rfft(sums, FINENESS * cells)) ** 2
    lowest = FINENESS * FEWEST_PERIODS
    line = lowest + int(np.argmax(power[lowest : FINENESS * highest]))
    half = line // 2
    # The strongest line may be the second harmonic; then the fundamental has half its frequency.
    if half >= lowest and power[half] > max(SHARE_OF_FUNDAMENTAL * power[line], power[2 * line]):
        line = half
    return stroke * FINENESS / line


def _without_trend(recording: Recording, along: Array, rest: Array) -> Array:
    """`rest` without what varies slower than a ripple along the stroke, for each direction."""
    slow = [np.cos(k * np.pi * along) for k in range(2 * FEWEST_PERIODS)]
    sign = np.sign(recording.velocity[recording.moving])
    columns = np.column_stack([*slow, *(sign * shape for shape in slow)])
    return np.asarray(rest - columns @ linear.least_norm(columns, rest))


def _plain_residual(recording: Recording) -> Array:
    """Residual of Coulomb and viscous friction with a rigid body, array [n]."""
    v, q, a = recording.velocity, recording.position, recording.acceleration
    assert q is not None
    columns = np.column_stack([np.sign(v), v, np.ones_like(v), a, np.cos(q), np.sin(q)])
    target = recording.torque - recording.known_torque
    moving = recording.moving
    solved = linear.least_norm(columns[moving], target[moving])
    return np.asarray(target - columns @ solved)
