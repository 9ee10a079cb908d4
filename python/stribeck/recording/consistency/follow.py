"""How well one channel is the integral of another, without differentiating either."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.motion.excerpt import stretches
from stribeck.recording.rows import noise_level

__all__ = ["Follows", "Track", "follows"]

#: Increments are compared, and noise is estimated, at no more than this many instants.
_MOST = 20_000
#: A signal with fewer levels than this is resolved by its steps.
_LEVELS = 20
#: An increment is motion where its RMS is this many standard deviations of its noise.
_SEEN = 5.0
#: Two channels follow each other from this share of common variance on, of what noise leaves.
_COMMON = 0.9
#: Delays are searched over this share of the longest segment.
_REACH = 0.1


@dataclass(frozen=True)
class Track:
    """Instants of a recording, arrays [n].

    Attributes
    ----------
    time, segment
        s; number of the contiguous stretch, in ascending order.
    """

    time: Floats
    segment: Ints

    def integral(self, rate: Floats) -> Floats:
        """The integral of `rate` over time by the trapezoidal rule, zero across gaps, [n]."""
        step = np.where(np.diff(self.segment) == 0, np.diff(self.time), 0.0)
        return np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * step)])

    def noise(self, values: Floats) -> float:
        """Standard deviation of the noise of a channel, from evenly spaced parts of it."""
        parts = stretches(len(values), _MOST, seed=0)
        rows = np.concatenate([np.arange(*part) for part in parts])
        part = np.repeat(np.arange(len(parts)), [stop - start for start, stop in parts])
        contiguous = np.diff(self.segment[rows], prepend=-1) != 0
        contiguous[1:] |= np.diff(part) != 0
        noise = noise_level(self.time[rows], values[rows], np.cumsum(contiguous))
        levels = np.unique(values[rows])
        # The steps of a signal with a few levels are its resolution, on a grid or not.
        few = 1 < levels.size < _LEVELS
        return max(noise, float(np.diff(levels).min()) / np.sqrt(12.0)) if few else noise

    @property
    def longest(self) -> int:
        """Number of samples of the longest segment."""
        edges = np.flatnonzero(np.diff(self.segment)) + 1
        bounds = np.concatenate([[0], edges, [len(self.segment)]])
        return int(np.diff(bounds).max())

    @property
    def period(self) -> float:
        """Median sampling period, s."""
        inside = np.diff(self.segment) == 0
        steps = np.diff(self.time)[inside]
        return float(np.median(steps)) if steps.size else 0.0


@dataclass(frozen=True)
class Follows:
    """How a channel follows the integral of another.

    Attributes
    ----------
    seen
        Whether the increments of `x` and of the integral stand out from their noise (two bools).
    should
        Whether those of the other would stand out from that noise, and are far larger (two bools).
    common
        Share of common variance of the increments at the best delay (squared correlation), of what
        their noise leaves.
    ratio, error
        d(x)/dt over the rate, and half the width of its interval.
    lag
        Time by which the rate is behind, s.
    phase
        That delay as an angle of the motion, rad.
    """

    seen: tuple[bool, bool]
    should: tuple[bool, bool]
    common: float
    ratio: float
    error: float
    lag: float
    phase: float

    @property
    def resolved(self) -> bool:
        """Whether the motion of one is above the resolution of the other, where one has none."""
        if not any(self.seen):
            return False
        return all(seen or should for seen, should in zip(self.seen, self.should, strict=True))

    @property
    def agrees(self) -> bool:
        """Whether the two are the same motion, up to a factor."""
        return self.common >= _COMMON


def follows(track: Track, x: Floats, rate: Floats) -> Follows:
    """Compare the increments of `x` with those of the integral of `rate`.

    Over windows of L samples, ``x[k+L] - x[k] = ratio * integral``. Noise and quantisation enter an
    increment once, whatever L is; the motion grows with L until it turns back. The L with the
    largest common variance is taken. Both sides pass through the same filter (a difference over
    L samples), so the relation holds exactly at every L. The two regression lines, of one on the
    other and reversed, enclose the ratio: their distance is the error. What the ratio changes by if
    every second sample alone is integrated is added to it.

    Parameters
    ----------
    track
        Times and segments, [n].
    x, rate
        The channel, and what should be its derivative, [n].
    """
    integral = track.integral(rate)
    noise_x = np.sqrt(2.0) * track.noise(x)
    noise_rate = track.noise(rate) * track.period
    best, seen, should = _Window(1, 0, 0.0, 1.0, 1.0), (False, False), (False, False)
    length, longest = 1, track.longest
    while length <= max(longest // 2, 1):
        found = _compare(track, x, integral, length, 0)
        if found is not None:
            least = _SEEN * noise_x, _SEEN * noise_rate * np.sqrt(length)
            seen = seen[0] or found.size_x > least[0], seen[1] or found.size_rate > least[1]
            should = (
                should[0] or found.size_rate > max(least[0], _SEEN * found.size_x),
                should[1] or found.size_x > max(least[1], _SEEN * found.size_rate),
            )
            best = max(best, found, key=lambda w: w.common)
        length *= 2
    best = _best_delay(track, x, integral, best, longest)
    low, high = best.slopes
    coarse = _compare(track, x, track.integral(_coarse(rate)), best.length, best.lag)
    sampling = 0.0 if coarse is None else abs(sum(coarse.slopes) - (low + high))
    error = 0.5 * (abs(high - low) + sampling)
    speed = float(np.sqrt(np.mean(rate**2)))
    change = float(np.sqrt(np.mean(np.diff(rate) ** 2))) / track.period if track.period else 0.0
    # The RMS change of a noisy rate is mostly noise: windows of the same length show the motion.
    pace = _pace(track, integral, best.length) or (change / speed if speed else 0.0)
    lag = best.lag * track.period
    left = 1.0 - (noise_x / best.size_x) ** 2 if best.size_x > noise_x else 0.0
    noise = noise_rate * np.sqrt(best.length)
    left *= 1.0 - (noise / best.size_rate) ** 2 if best.size_rate > noise else 0.0
    # White noise is the worst case: that of a difference cancels in its integral.
    common = max(best.common, min(1.0, best.common / left) if left > 0.0 else 0.0)
    if best.common >= _COMMON:
        seen = seen[0], True
    return Follows(seen, should, common, 0.5 * (low + high), error, lag, abs(lag) * pace)


@dataclass(frozen=True)
class _Window:
    """Increments over `length` samples, the integral `lag` samples later."""

    length: int
    lag: int
    product: float
    size_x: float
    size_rate: float

    @property
    def common(self) -> float:
        """Squared correlation."""
        both = (self.size_x * self.size_rate) ** 2
        return self.product**2 / both if both > 0.0 else 0.0

    @property
    def slopes(self) -> tuple[float, float]:
        """The two regression lines, in ascending size."""
        if self.product == 0.0:
            return 0.0, 0.0
        return self.product / self.size_rate**2, self.size_x**2 / self.product


def _compare(track: Track, x: Floats, integral: Floats, length: int, lag: int) -> _Window | None:
    """Mean product and RMS of the increments; None where no window fits into a segment."""
    n = len(x)
    first, last = max(0, -lag), n - length - max(0, lag)
    if last - first < 8:
        return None
    k = np.arange(first, last, max(1, (last - first) // _MOST))
    lowest, highest = k + min(lag, 0), k + length + max(lag, 0)
    k = k[track.segment[lowest] == track.segment[highest]]
    if k.size < 8:
        return None
    dx = x[k + length] - x[k]
    di = integral[k + lag + length] - integral[k + lag]
    return _Window(
        length,
        lag,
        float(np.mean(dx * di)),
        float(np.sqrt(np.mean(dx**2))),
        float(np.sqrt(np.mean(di**2))),
    )


def _coarse(rate: Floats) -> Floats:
    """Every second sample, and the line between them."""
    coarse = rate.copy()
    coarse[1:-1:2] = 0.5 * (rate[:-2:2] + rate[2::2])
    return coarse


def _best_delay(track: Track, x: Floats, integral: Floats, start: _Window, longest: int) -> _Window:
    """The window at the delay with the largest common variance.

    Channels that agree without a delay are followed to the nearest maximum; otherwise the whole
    reach is searched, at a length that is short against it.
    """
    reach = int(_REACH * longest)
    if start.common < _COMMON:
        lengths = {start.length, max(1, start.length // 4), max(1, start.length // 16)}
        found = [
            _compare(track, x, integral, length, lag)
            for length in sorted(lengths)
            for lag in range(-reach, reach + 1, max(1, length // 4, reach // 200))
        ]
        start = max([start, *(w for w in found if w is not None)], key=lambda w: w.common)
        if start.common < _COMMON:
            return start
    step = max(1, start.length // 8)
    while step:
        near = [_compare(track, x, integral, start.length, start.lag + d) for d in (-step, step)]
        better = max([start, *(w for w in near if w is not None)], key=lambda w: w.common)
        if better is start or abs(better.lag) > reach:
            step //= 2
        else:
            start = better
    return start


def _pace(track: Track, integral: Floats, length: int) -> float | None:
    """RMS rate of change of the motion over its RMS size, 1/s; None where windows are too few."""
    size = _compare(track, integral, integral, length, 0)
    if size is None or size.size_x == 0.0 or track.period == 0.0:
        return None
    half = max(1, length // 4)
    later = _compare(track, integral, integral, length, half)
    if later is None:
        return None
    # Of a motion at one frequency w, the correlation at a delay d is cos(w d).
    cosine = np.clip(later.product / (later.size_x * later.size_rate), -1.0, 1.0)
    return float(np.arccos(cosine)) / (half * track.period)
