"""Stretches that no friction model explains: approach moves, abrupt stops, blows.

They happen once, where an effect comes back again and again. They are reported, and left out
of the rows that the parameters are fitted to, so that they do not drive the answer; the error
figures keep them, since the rows scored are the same for every model.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.figures import zero_phase
from stribeck.recording import Recording

Array = NDArray[np.float64]

#: Share of the rows that may be called transient; more than that is how the machine works.
MOST = 0.12
WINDOWS = 60
FACTOR = 4.0
#: What happens more often than this is not a transient but something to be explained.
STRETCHES = 3


def flexible_columns(recording: Recording) -> Array:
    """Columns of a deliberately flexible friction model, array [n, k].

    Smooth curves of speed in either direction, position and temperature, and the rigid body.
    """
    v = recording.velocity
    speed = recording.scales()["speed"] or 1.0
    sign = np.sign(v)
    x = np.abs(v) / speed
    columns = [sign, v, sign * x**0.5, sign * x**2, sign * np.exp(-x / 0.05)]
    columns += [np.abs(sign), x, np.ones_like(v)]
    if recording.acceleration is not None:
        columns.append(recording.acceleration)
    if recording.position is not None:
        q = recording.position
        span = np.ptp(q) or 1.0
        u = (q - q.min()) / span
        if recording.joint_kind == "revolute":
            columns += [np.cos(q), np.sin(q)]
        columns += [sign * np.cos(k * np.pi * u) for k in range(1, 5)]
    if recording.temperature is not None:
        t = recording.temperature - recording.temperature.mean()
        columns += [sign * t, v * t]
    tl = recording.load_torque
    if tl is not None:
        columns += [sign * np.abs(tl), tl]
    return np.column_stack(columns)


def transient_rows(recording: Recording) -> NDArray[np.bool_]:
    """Rows of stretches whose filtered residual no flexible model brings down, bool [n]."""
    none = np.zeros(recording.time.size, dtype=bool)
    moving = recording.moving
    if recording.averaged or moving.sum() < 20 * WINDOWS:
        return none
    columns = flexible_columns(recording)
    size = np.sqrt((columns[moving] ** 2).mean(axis=0))
    columns = columns[:, size > 0] / size[size > 0]
    target = recording.torque
    if recording.load_torque is not None:
        target = target - recording.load_torque
    marked = none
    window = np.minimum(
        np.cumsum(moving) * WINDOWS // max(int(moving.sum()), 1), WINDOWS - 1
    ).astype(np.intp)
    for _ in range(4):
        kept = moving & ~marked
        solution = np.linalg.lstsq(columns[kept], target[kept], rcond=1e-8)[0]
        residual = np.where(moving, target - columns @ solution, 0.0)
        filtered = zero_phase(recording, residual)
        square = np.bincount(window[moving], filtered[moving] ** 2, WINDOWS)
        count = np.bincount(window[moving], minlength=WINDOWS)
        level = np.sqrt(square / np.maximum(count, 1))
        wild = level > FACTOR * np.median(level)
        again = moving & wild[window]
        often = np.count_nonzero(np.diff(wild.astype(int), prepend=0) == 1) > STRETCHES
        if not again.any() or often or again.sum() > MOST * moving.sum():
            return marked
        if np.array_equal(again, marked):
            break
        marked = again
    return marked


def stretches(recording: Recording, marked: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Start and end times of the marked stretches, merged over rows at rest, in s."""
    rows = np.flatnonzero(marked)
    if rows.size == 0:
        return []
    cuts = np.flatnonzero(np.diff(recording.time[rows]) > 1.0) + 1
    return [
        (float(recording.time[piece[0]]), float(recording.time[piece[-1]]))
        for piece in np.split(rows, cuts)
    ]
