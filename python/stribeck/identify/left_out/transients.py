"""Transients that no friction model explains: approach moves, abrupt stops, impacts.

They happen once, whereas an effect acts again and again. They are reported and excluded from the
fit, so that they do not bias the parameters. Error figures include them, since the scored samples
are the same for every model.

A drive train, an inertia or a delay causes large errors wherever the joint accelerates hard. The
error of a stretch is therefore compared with that of the stretches of similar acceleration too.

A flexible model is wrong where the motion goes beyond the rest. A stretch that a model of a few
columns explains as well as a flexible one explains the others is no transient either, nor are the
fastest passes of a friction map, to which every model of the others is extrapolated.
"""

from __future__ import annotations

import itertools
from functools import partial

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.identify.figures import zero_phase
from stribeck.identify.normal import NormalEquations
from stribeck.recording.blocks.speeds_once import passes_speeds_once
from stribeck.recording.motion.any_friction import AnyFriction
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Largest share of samples that are transient; what is more frequent is normal operation.
MOST = 0.12
#: Number of windows of a recording.
WINDOWS = 60
#: A window is an outlier if its error, filtered or raw, exceeds the median by such a factor: the
#: median of all windows, and that of this many windows whose acceleration is most similar.
OUTLIER_FILTERED, OUTLIER_RAW = 4.0, 3.0
SIMILAR = 5
#: It is none if the error of the simple model there is at most this many times that median.
USUAL = 1.75
#: Quantiles of the speed of a window: what a quarter of it exceeds, and its highest.
UPPER, HIGHEST = 0.75, 0.99
#: Most transients; what happens more often needs an explanation.
STRETCHES = 3


def flexible_columns(recording: Recording) -> list[Array]:
    """Columns of a deliberately flexible friction model, arrays [n]; see `AnyFriction`."""
    r = recording
    depends = AnyFriction(
        r.velocity,
        r.scales()["speed"],
        r.joint_kind == "revolute",
        r.position,
        r.temperature,
        r.load_torque,
    )
    return depends.columns(r.acceleration)


def simple_columns(recording: Recording) -> list[Array]:
    """Columns of an ordinary model: dry and viscous friction, inertia, spring, load; arrays [n]."""
    v = recording.velocity
    columns = [np.sign(v), v, np.ones_like(v)]
    if recording.acceleration is not None:
        columns.append(recording.acceleration)
    if recording.position is not None:
        q = recording.position
        u = 2.0 * (q - q.min()) / (np.ptp(q) or 1.0) - 1.0
        columns += [u, u**2, u**3]
    if recording.load_torque is not None:
        columns.append(recording.load_torque)
    return columns


def transient_rows(
    recording: Recording, apart: NDArray[np.bool_] | None = None
) -> NDArray[np.bool_]:
    """Samples of transients, bool [n]: windows that a flexible model does not fit.

    Parameters
    ----------
    apart : bool array [n]
        Samples that are not looked at; default: none.
    """
    none = np.zeros(recording.time.size, dtype=bool)
    moving = recording.moving if apart is None else recording.moving & ~apart
    if recording.averaged or moving.sum() < 20 * WINDOWS:
        return none
    columns = of_one_size(flexible_columns(recording), moving)
    simple = of_one_size(simple_columns(recording), moving)
    target = recording.torque - recording.known_torque
    window = np.minimum(
        np.cumsum(moving) * WINDOWS // max(int(moving.sum()), 1), WINDOWS - 1
    ).astype(np.uint32)
    similar = _similar(_levels(recording.acceleration_smooth, window, moving))
    faster = np.zeros(WINDOWS, dtype=bool)
    if passes_speeds_once(recording):
        faster = _faster_than_slower_ones(np.abs(recording.velocity), window, moving)
    marked = none
    for _ in range(4):
        kept = moving & ~marked
        by_flexible, by_simple = (
            _left_out(part, target, window, moving, kept) for part in (columns, simple)
        )
        outlier, unlike = _outliers(recording, by_flexible, by_simple, window, moving, similar)
        outlier, unlike = outlier & ~faster, unlike & ~faster
        again = moving & unlike[window]
        frequent = np.count_nonzero(np.diff(outlier.astype(int), prepend=0) == 1) > STRETCHES
        many = (moving & outlier[window]).sum() > MOST * moving.sum()
        if frequent or many or np.array_equal(again, marked):
            break
        marked = again
    return marked


def _outliers(
    recording: Recording,
    by_flexible: Array,
    by_simple: Array,
    window: NDArray[np.uint32],
    moving: NDArray[np.bool_],
    similar: NDArray[np.intp],
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Windows of large error, and those of them that are transients, bool [WINDOWS] each."""
    outlier = unlike = np.zeros(WINDOWS, dtype=bool)
    for shown, factor in (
        (partial(zero_phase, recording), OUTLIER_FILTERED),
        (np.copy, OUTLIER_RAW),
    ):
        level = _levels(shown(by_flexible), window, moving)
        # The motion differs between windows: an outlier also exceeds the worst normal ones.
        normal = max(float(np.median(level)) * factor, 1.5 * float(np.quantile(level, 0.9)))
        large = level > normal
        outlier = outlier | large
        usual = USUAL * float(np.median(level))
        explained = _levels(shown(by_simple), window, moving) <= usual
        alone = level > factor * np.median(level[similar], axis=1)
        unlike = unlike | (large & alone & ~explained)
    return outlier, unlike


def _levels(values: Array, window: NDArray[np.uint32], moving: NDArray[np.bool_]) -> Array:
    """RMS of the moving samples of each window, array [WINDOWS]."""
    count = np.bincount(window[moving], minlength=WINDOWS)
    square = np.bincount(window[moving], values[moving] ** 2, WINDOWS)
    return np.asarray(np.sqrt(square / np.maximum(count, 1)))


def _faster_than_slower_ones(
    speed: Array, window: NDArray[np.uint32], moving: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Windows a quarter of which is faster than the slower windows ever are, bool [WINDOWS]."""
    upper, highest = np.zeros(WINDOWS), np.zeros(WINDOWS)
    for w in range(WINDOWS):
        own = speed[moving & (window == w)]
        if own.size:
            upper[w], highest[w] = np.quantile(own, (UPPER, HIGHEST))
    order = np.argsort(upper, kind="stable")
    slower = np.maximum.accumulate(highest[order])
    faster = np.zeros(WINDOWS, dtype=bool)
    faster[order[1:]] = upper[order[1:]] > slower[:-1]
    return faster


def _similar(acceleration: Array) -> NDArray[np.intp]:
    """The other windows of closest acceleration, as a ratio, int array [WINDOWS, SIMILAR]."""
    size = np.log(np.maximum(acceleration, np.finfo(float).tiny))
    apart = np.abs(size[:, None] - size)
    np.fill_diagonal(apart, np.inf)
    return np.argsort(apart, axis=1, kind="stable")[:, :SIMILAR]


def of_one_size(columns: list[Array], moving: NDArray[np.bool_]) -> Array:
    """Columns with a mean square of 1 over the `moving` samples, array [n, k], without zero ones.

    The list is emptied: each column is freed once it is copied, since long recordings fill the
    memory.
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
    """Residual [n] of each window by a fit to the `kept` samples of the others; 0 at rest."""
    # Samples that are not kept go to a group of their own: this needs no copy of the others.
    sums = NormalEquations.of(columns, target, np.where(kept, window, WINDOWS), WINDOWS + 1)
    matrix, vector = sums.matrix[:WINDOWS].sum(axis=0), sums.vector[:WINDOWS].sum(axis=0)
    ridge = 1e-6 * kept.sum() * np.eye(columns.shape[1])
    residual = np.zeros_like(target)
    first = np.searchsorted(window, np.arange(WINDOWS + 1))
    for w, (start, stop) in enumerate(itertools.pairwise(first)):
        left = linear.solve(matrix - sums.matrix[w] + ridge, vector - sums.vector[w])
        rows = slice(start, stop)
        residual[rows] = np.where(moving[rows], target[rows] - columns[rows] @ left, 0.0)
    return residual


def stretches(recording: Recording, marked: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """Start and end times of marked samples in s, merged across samples at rest within a run."""
    rows = np.flatnonzero(marked)
    if rows.size == 0:
        return []
    apart = (np.diff(recording.time[rows]) > 1.0) | (np.diff(recording.run[rows]) != 0)
    cuts = np.flatnonzero(apart) + 1
    return [
        (float(recording.time[piece[0]]), float(recording.time[piece[-1]]))
        for piece in np.split(rows, cuts)
    ]
