"""Samples: segments, gaps, noise of a signal and held-out blocks."""

from __future__ import annotations

import itertools

import numpy as np

from stribeck import _core
from stribeck.recording.arrays import Bools, Floats, Ints

__all__ = [
    "BLOCKS",
    "GAP",
    "MANY_RUNS",
    "SIGMAS",
    "equal_stretches",
    "held_out_blocks",
    "neighbour",
    "noise_level",
    "predictable",
    "quantisation_step",
    "segment_rows",
    "segment_slices",
    "slope_noise",
]

#: A step longer than this many median steps starts a new segment.
GAP = 5.0
#: A sample moves when its speed is above this many standard deviations of the velocity noise.
SIGMAS = 5.0
#: A signal that takes each of its values this often on average is a list of settings.
VISITS = 20
#: Noise is sought at longer steps in stretches of at least this many samples at that step, and is
#: smaller than this share of the signal.
_LEAST, _SMALL = 64, 0.1
#: Held-out blocks of a recording with few runs.
BLOCKS = 10
#: From this number of runs on, each run is a held-out block.
MANY_RUNS = 5


def segment_rows(time: Floats, run: Ints, row: Ints) -> tuple[Ints, Floats, float]:
    """Number the segments of a recording: its contiguous stretches.

    A segment ends where the run ends, where samples were removed, and where the step is longer than
    `GAP` times the median step of that run (runs of one file may have their own rates).

    Parameters
    ----------
    time
        Time of each sample [s], increasing within a run.
    run
        Run number of each sample, runs contiguous.
    row
        Row of the file of each sample, which shows where samples were removed.

    Returns
    -------
    tuple
        Segment of each sample, step to the previous sample [s] (0 at each segment start), and the
        median step of the recording [s].
    """
    n = len(time)
    if n < 2:
        return np.zeros(n, dtype=np.int64), np.zeros(n), 0.0
    step = np.diff(time)
    inside = run[1:] == run[:-1]
    adjacent = inside & (np.diff(row) == 1)
    usable = adjacent if adjacent.any() else inside
    overall = float(np.median(step[usable])) if usable.any() else 0.0
    limit = np.full(n - 1, GAP * overall)
    starts = np.flatnonzero(np.concatenate(([True], ~inside)))
    ends = np.append(starts[1:], n)
    for first, last in zip(starts, ends, strict=True):
        own = step[first : last - 1][usable[first : last - 1]]
        if own.size:
            limit[first : last - 1] = GAP * float(np.median(own))
    joined = adjacent & (step <= limit)
    segment = np.concatenate(([0], np.cumsum(~joined))).astype(np.int64)
    dt = np.concatenate(([0.0], np.where(joined, step, 0.0)))
    return segment, dt, overall


def segment_slices(segment: Ints) -> list[slice]:
    """Return one slice per segment, in order."""
    edges = np.flatnonzero(np.diff(segment)) + 1
    bounds = np.concatenate(([0], edges, [len(segment)]))
    return [slice(int(a), int(b)) for a, b in itertools.pairwise(bounds) if b > a]


def neighbour(values: Floats, segment: Ints, rows: int) -> Floats:
    """`values` [n] so many `rows` later; the same value beyond the end of a segment."""
    at = np.clip(np.arange(values.size) + rows, 0, values.size - 1)
    return np.where(segment[at] == segment, values[at], values)


def predictable(velocity: Floats, smooth: Floats, segment: Ints, threshold: float) -> Bools:
    """The samples whose friction a model can predict, bool [n].

    They are faster than the `threshold`, and the direction of the samples beside them is known: the
    recorded velocity and the smooth one have the same sign there. A torque that is late or early by
    less than a sample is in part that of the next one: were its direction unknown, one such sample
    could be wrong by twice the dry friction.

    Parameters
    ----------
    velocity, smooth
        As recorded, and behind a zero-phase low-pass, [n].

    Examples
    --------
    >>> speed = np.array([-1.0, -0.5, 0.01, 0.5, 1.0])
    >>> smooth = np.array([-1.0, -0.5, -0.01, 0.5, 1.0])
    >>> predictable(speed, smooth, np.zeros(5, dtype=np.int64), threshold=0.1)
    array([ True, False, False, False,  True])
    """
    unknown = (velocity * smooth < 0.0).astype(np.float64)
    beside = [neighbour(unknown, segment, step) > 0.0 for step in (-1, 1)]
    return (np.abs(velocity) > threshold) & ~np.any(beside, axis=0)


def quantisation_step(values: Floats) -> float:
    """Return the step of a quantised signal, or 0 when its values lie on no grid."""
    if values.size < 20:
        return 0.0
    levels = np.unique(values)
    gaps = np.diff(levels)
    span = float(np.abs(values).max())
    gaps = gaps[gaps > 1e-9 * span]
    if gaps.size < 3:
        return 0.0
    step = float(np.percentile(gaps, 5.0))
    # Rounded text and float32 blur a grid a little; a random set of levels fails this at once.
    near = gaps[gaps <= step * 1.5]
    step = float(np.median(near))
    ratio = gaps / step
    on_grid = np.abs(ratio - np.round(ratio)) < 0.05
    return step if float(on_grid.mean()) > 0.9 else 0.0


def noise_level(time: Floats, value: Floats, segment: Ints, quantum: float | None = None) -> float:
    """Standard deviation of the white noise on a signal, from its high-order differences.

    Differences of order 2 to 5 remove more and more of the motion and leave the noise. The first
    order that agrees with the next within a tenth is taken, or the smallest noise if none does. A
    quantised signal has at least step/sqrt(12). Noise that is correlated from sample to sample, as
    that of a filtered or resampled signal, is looked for at longer steps. A signal with few values
    that lie on no grid (the speeds of a static friction curve) is a list of settings, which has no
    noise.

    Parameters
    ----------
    time, value, segment
        The signal and its segments; differences never cross segments.
    quantum
        Quantisation step, if it is known.
    """
    step = quantisation_step(value) if quantum is None else quantum
    if step == 0.0 and np.unique(value).size * VISITS <= value.size:
        return 0.0
    slices = segment_slices(segment)
    sigmas = _noise_by_order(time, value, slices)
    sigma = min(sigmas, default=0.0)
    for this, following in itertools.pairwise(sigmas):
        if _alike(this, following):
            sigma = min(this, following)
            break
    if step == 0.0 and not _is_white(sigmas):
        sigma = max(sigma, _correlated_noise(time, value, slices)[0])
    return float(max(sigma, step / np.sqrt(12.0)))


def slope_noise(time: Floats, value: Floats, segment: Ints, period: float) -> float:
    """Standard deviation of the noise on the difference quotient of a signal, and its resolution.

    White noise enters with both samples of a difference. Noise that is smooth over a few samples
    enters by what is white over as many. Samples that are far apart for the motion do not resolve
    the slope between them (`_slope_error`).

    Parameters
    ----------
    period
        Sampling period, s.
    """
    sigma, steps = noise_level(time, value, segment), 1
    correlated, over = _correlated_noise(time, value, segment_slices(segment))
    if correlated == sigma:
        steps = over
    noise = float(np.sqrt(2.0) * sigma / (steps * period))
    return max(noise, _slope_error(time, value, segment))


def _noise_by_order(time: Floats, value: Floats, slices: list[slice]) -> list[float]:
    """The noise from differences of order 2 to 5, as far as the samples allow."""
    sigmas: list[float] = []
    for order in (2, 3, 4, 5):
        found = [_core.divided_differences(time[part], value[part], order) for part in slices]
        d = np.concatenate(found) if found else np.empty(0)
        if d.size < 5:
            break
        sigmas.append(float(np.median(np.abs(d))) / 0.6745)
    return sigmas


def _alike(this: float, following: float) -> bool:
    return this > 0.0 and abs(this - following) <= 0.1 * this


def _is_white(sigmas: list[float]) -> bool:
    """Whether differences of order 3 to 5 see the same noise; those of order 2 may see motion."""
    return len(sigmas) == 4 and all(_alike(a, b) for a, b in itertools.pairwise(sigmas[1:]))


def _correlated_noise(time: Floats, value: Floats, slices: list[slice]) -> tuple[float, int]:
    """Noise that a filter or resampling has made smooth, and over how many samples; 0 if unseen.

    Differences of neighbouring samples hardly see it. They do over longer steps, where it is white
    again: the first power of two is taken at which the orders agree. A motion that is undersampled
    at that step looks white too, but is not small against itself.
    """
    size = float(np.std(value))
    for stride in (2, 4, 8, 16):
        kept = [slice(s.start, s.stop, stride) for s in slices]
        kept = [s for s in kept if (s.stop - s.start) // stride >= _LEAST]
        sigmas = _noise_by_order(time, value, kept)
        if _is_white(sigmas):
            sigma = float(np.median(sigmas))
            return (sigma, stride) if sigma < _SMALL * size else (0.0, 1)
    return 0.0, 1


def _slope_error(time: Floats, value: Floats, segment: Ints) -> float:
    """RMS error of the slope of a signal between its samples, from two step lengths.

    The central difference over one sample to each side, minus that over two, is three times the
    error of the first where the signal is smooth (Richardson 1911), and of its size where the
    signal has a corner.
    """
    found: list[Floats] = []
    for part in segment_slices(segment):
        t, x = time[part], value[part]
        if len(t) < 5:
            continue
        near = (x[3:-1] - x[1:-3]) / (t[3:-1] - t[1:-3])
        far = (x[4:] - x[:-4]) / (t[4:] - t[:-4])
        found.append((near - far) / 3.0)
    return float(np.sqrt(np.mean(np.concatenate(found) ** 2))) if found else 0.0


def held_out_blocks(dt: Floats, segment: Ints, run: Ints, typical: float) -> tuple[Ints, int]:
    """Assign every sample to a held-out block.

    Ten contiguous blocks of equal recorded duration (a gap counts as one step), or whole runs when
    there are at least five.
    """
    n = len(dt)
    runs = int(run.max()) + 1 if n else 0
    if runs >= MANY_RUNS:
        return run.copy(), runs
    count = min(BLOCKS, n)
    return equal_stretches(dt, typical, count), count


def equal_stretches(dt: Floats, typical: float, count: int) -> Ints:
    """The number of the contiguous stretch of each sample, [n]: `count` of equal recorded duration.

    A gap counts as one `typical` step.
    """
    step = np.where(dt > 0.0, dt, typical if typical > 0.0 else 1.0)
    clock = np.cumsum(step) - 0.5 * step
    total = float(step.sum())
    return np.minimum((clock / total * count).astype(np.int64), count - 1)
