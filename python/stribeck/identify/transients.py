"""Stretches that no friction model explains: approach moves, abrupt stops, blows.

They happen once, where an effect comes back again and again. They are reported, and left out
of the rows that the parameters are fitted to, so that they do not drive the answer; the error
figures keep them, since the rows scored are the same for every model.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from stribeck.identify.figures import zero_phase
from stribeck.identify.normal import NormalEquations
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Share of the rows that may be called transient; more than that is how the machine works.
MOST = 0.12
#: The recording is looked at in this many windows.
WINDOWS = 60
#: A window is wild if its error exceeds so many times the median window's, slow and raw.
WILD_SLOW, WILD_RAW = 4.0, 3.0
#: What happens more often than this is not a transient but something to be explained.
STRETCHES = 3


def flexible_columns(recording: Recording) -> list[Array]:
    """Columns of a deliberately flexible friction model, arrays [n].

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
    return columns


def transient_rows(recording: Recording) -> NDArray[np.bool_]:
    """Rows of stretches whose filtered residual no flexible model brings down, bool [n]."""
    none = np.zeros(recording.time.size, dtype=bool)
    moving = recording.moving
    if recording.averaged or moving.sum() < 20 * WINDOWS:
        return none
    columns = _of_one_size(flexible_columns(recording), moving)
    target = recording.torque - recording.known_torque
    window = np.minimum(
        np.cumsum(moving) * WINDOWS // max(int(moving.sum()), 1), WINDOWS - 1
    ).astype(np.uint32)
    count = np.bincount(window[moving], minlength=WINDOWS)
    marked = none
    for _ in range(4):
        residual = _left_out(columns, target, window, moving, moving & ~marked)
        slow = zero_phase(recording, residual)
        wild = np.zeros(WINDOWS, dtype=bool)
        for values, factor in ((slow, WILD_SLOW), (residual, WILD_RAW)):
            square = np.bincount(window[moving], values[moving] ** 2, WINDOWS)
            level = np.sqrt(square / np.maximum(count, 1))
            # Windows differ in what the joint does: a wild one stands out from the worst
            # ordinary ones too.
            ordinary = max(float(np.median(level)) * factor, 1.5 * float(np.quantile(level, 0.9)))
            wild |= level > ordinary
        again = moving & wild[window]
        often = np.count_nonzero(np.diff(wild.astype(int), prepend=0) == 1) > STRETCHES
        if often or again.sum() > MOST * moving.sum() or np.array_equal(again, marked):
            break
        marked = again
    return marked


def _of_one_size(columns: list[Array], moving: NDArray[np.bool_]) -> Array:
    """Columns with a mean square of 1 over the `moving` rows, array [n, k]; none that is nothing.

    Long recordings fill the memory with them: each is let go as soon as it is in place.
    """
    made = np.empty((moving.size, len(columns)))
    used = 0
    for _ in range(len(columns)):
        column = columns.pop(0)
        size = np.sqrt((column[moving] ** 2).mean())
        if size > 0:
            np.divide(column, size, out=made[:, used])
            used += 1
    return made[:, :used]


def _left_out(
    columns: Array,
    target: Array,
    window: NDArray[np.uint32],
    moving: NDArray[np.bool_],
    kept: NDArray[np.bool_],
) -> Array:
    """Residual of each window by the fit to the other windows' `kept` rows; 0 at rest."""
    # What is not kept is summed apart: no copy of the others is made.
    sums = NormalEquations.of(columns, target, np.where(kept, window, WINDOWS), WINDOWS + 1)
    matrix, vector = sums.matrix[:WINDOWS].sum(axis=0), sums.vector[:WINDOWS].sum(axis=0)
    ridge = 1e-6 * kept.sum() * np.eye(columns.shape[1])
    residual = np.zeros_like(target)
    first = np.searchsorted(window, np.arange(WINDOWS + 1))
    for w, (start, stop) in enumerate(itertools.pairwise(first)):
        left = np.linalg.solve(matrix - sums.matrix[w] + ridge, vector - sums.vector[w])
        rows = slice(start, stop)
        residual[rows] = np.where(moving[rows], target[rows] - columns[rows] @ left, 0.0)
    return residual


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
