"""Constant-speed intervals of a displacement log, in which the position is linear in time.

Split and merge: a line is fitted by least squares, and split at the best break into two lines where
two fit better than one; neighbours that fit one line are merged again. Positions are not
differentiated, which would amplify the noise of the sensor.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.recording.rows import segment_slices

Array = NDArray[np.float64]

#: Two lines fit better than one if they lower the sum of squares by so many residual variances:
#: F(2, n) exceeds this by chance at one in 10^6 breaks.
SIGNIFICANT = 30.0
#: A residual is smooth if its squared differences sum to less than this share of its squares.
SMOOTH = 0.5
#: Fewest samples on either side of a break.
FEWEST = 4
#: A joint moves if its speed is at least so many times the speed's standard error.
SIGMAS = 5.0


@dataclass(frozen=True)
class Line:
    """A straight line through the positions of the samples `start` to `stop` (exclusive).

    Attributes
    ----------
    velocity, stderr
        Slope and its standard error, in rad/s or m/s.
    time, position
        A point of the line: the means, in s and rad or m.
    rms
        RMS of the distances from the line, in rad or m.
    """

    start: int
    stop: int
    velocity: float
    stderr: float
    time: float
    position: float
    rms: float

    @classmethod
    def through(cls, time: Array, position: Array, start: int, stop: int) -> Line:
        """Fit a line to the samples `start` to `stop` by least squares."""
        t, x = time[start:stop], position[start:stop]
        middle, height = float(t.mean()), float(x.mean())
        t, x = t - middle, x - height
        spread = float(t @ t)
        slope = float(t @ x) / spread
        residual = x - slope * t
        square = float(residual @ residual)
        variance = square / max(t.size - 2, 1)
        return cls(
            start=start,
            stop=stop,
            velocity=slope,
            stderr=float(np.sqrt(variance / spread)),
            time=middle,
            position=height,
            rms=float(np.sqrt(square / t.size)),
        )

    def at(self, time: Array) -> Array:
        """Position on the line at `time`, array of the same shape."""
        return self.position + self.velocity * (time - self.time)

    @property
    def rows(self) -> int:
        """Number of samples."""
        return self.stop - self.start

    def ends(self, time: Array) -> tuple[float, float]:
        """Positions on the line at its first and last sample, rad or m."""
        first, last = self.at(time[[self.start, self.stop - 1]])
        return float(first), float(last)


@dataclass(frozen=True)
class Search:
    """Criteria of a constant-speed interval.

    Attributes
    ----------
    tolerance
        Largest relative difference of speed within an interval; also the largest relative
        standard error of its speed.
    shortest
        Shortest duration of an interval in s.
    trim
        Share of each end that is left out, where starting and stopping may still have an effect.
    """

    tolerance: float = 0.05
    shortest: float = 0.2
    trim: float = 0.05

    def check(self) -> None:
        """Refuse values out of range.

        Raises
        ------
        FitError
        """
        if not 0.0 < self.tolerance < 1.0:
            raise FitError(
                f"{option('tolerance', self.tolerance)} is out of range: give a share, 0..1"
            )
        if not (math.isfinite(self.shortest) and self.shortest > 0.0):
            raise FitError(
                f"{option('shortest', self.shortest)} is out of range: give seconds above 0"
            )
        if not 0.0 <= self.trim < 0.5:
            raise FitError(
                f"{option('trim', self.trim)} is out of range: give a share, 0 to below 0.5"
            )


def constant_speed(
    time: Array, position: Array, segment: NDArray[np.int64], search: Search | None = None
) -> list[Line]:
    """Find the intervals in which a joint moves at constant speed.

    Parameters
    ----------
    time, position : array [n]
        In s, and rad or m as measured: the lines average noise and quantisation.
    segment : int array [n]
        Number of the segment without a gap; no line crosses a gap.
    search : Search

    Returns
    -------
    list of Line
        In order of time, trimmed; may be empty.

    Examples
    --------
    >>> t = np.arange(0.0, 4.0, 0.01)
    >>> x = np.interp(t, [1.0, 3.0], [0.0, 0.5])
    >>> [round(line.velocity, 3) for line in constant_speed(t, x, np.zeros(400, dtype=int))]
    [0.25]
    """
    search = search or Search()
    found: list[Line] = []
    for part in segment_slices(segment):
        pieces = list(_split(time, position, part.start, part.stop, search))
        for line in _merge(time, position, pieces, search):
            inner = Line.through(time, position, *_inner(line.start, line.stop, search))
            if _moves(inner, search):
                found.append(inner)
    return found


def _split(time: Array, position: Array, start: int, stop: int, search: Search) -> Iterator[Line]:
    """Straight pieces of the samples `start` to `stop`, in order of time."""
    waiting = [(start, stop)]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2 * FEWEST or time[b - 1] - time[a] < search.shortest:
            continue
        at = _break(time, position, a, b, search)
        if at is None:
            yield Line.through(time, position, a, b)
        else:
            # The earlier part comes first.
            waiting += [(at, b), (a, at)]


def _break(time: Array, position: Array, start: int, stop: int, search: Search) -> int | None:
    """The sample at which a second line begins; None where one line is enough."""
    t = time[start:stop] - time[start:stop].mean()
    x = position[start:stop] - position[start:stop].mean()
    slope = float(t @ x) / float(t @ t)
    residual = x - slope * t
    left, slope_left = _growing_lines(t, x)
    right, slope_right = _growing_lines(t[::-1], x[::-1])
    # Entry k of each: the first k + 1 samples and the last n - k - 1.
    two = left[:-1] + right[::-1][1:]
    k = int(np.argmin(two[FEWEST - 1 : t.size - FEWEST])) + FEWEST - 1
    first, second = slope_left[k], slope_right[::-1][k + 1]
    differs = abs(first - second) > search.tolerance * max(abs(first), abs(second))
    fall = float(residual @ residual) - float(two[k])
    better = fall > SIGNIFICANT * max(float(two[k]), 0.0) / max(t.size - 4, 1)
    bent = _is_bent(residual, abs(slope) * float(np.sqrt(t @ t)), search)
    return start + k + 1 if (differs and better) or bent else None


def _is_bent(residual: Array, spread: float, search: Search) -> bool:
    """Whether the speed changes in a way that two lines do not fit either.

    Examples are many passes back and forth, and a speed that rises and falls again. The latter, by
    the share p of the speed, bends the position by 0.39 p of the line's spread. The residual is
    then smooth, unlike noise, whose von Neumann ratio is near 2.
    """
    square = float(residual @ residual)
    rough = float((np.diff(residual) ** 2).sum())
    much = square > (0.39 * search.tolerance * spread) ** 2
    return square > spread**2 or (much and rough < SMOOTH * square)


def _growing_lines(t: Array, x: Array) -> tuple[Array, Array]:
    """Sum of squares and slope of the lines through the first 1, 2, ... n samples, arrays [n]."""
    count = np.arange(1.0, t.size + 1.0)
    st, sx = np.cumsum(t), np.cumsum(x)
    tt = np.cumsum(t * t) - st * st / count
    tx = np.cumsum(t * x) - st * sx / count
    xx = np.cumsum(x * x) - sx * sx / count
    slope = np.divide(tx, tt, out=np.zeros_like(tx), where=tt > 0)
    return np.maximum(xx - slope * tx, 0.0), slope


def _merge(time: Array, position: Array, pieces: list[Line], search: Search) -> Iterator[Line]:
    """Join neighbours that fit one line, apart from the trimmed ends."""
    current: Line | None = None
    for piece in pieces:
        if current is not None and current.stop == piece.start:
            start, stop = _inner(current.start, piece.stop, search)
            if _break(time, position, start, stop, search) is None:
                current = Line.through(time, position, current.start, piece.stop)
                continue
        if current is not None:
            yield current
        current = piece
    if current is not None:
        yield current


def _inner(start: int, stop: int, search: Search) -> tuple[int, int]:
    """First and last of the samples `start` to `stop` without the trimmed ends."""
    cut = min(int(search.trim * (stop - start)), (stop - start) // 2 - FEWEST)
    return start + cut, stop - cut


def _moves(line: Line, search: Search) -> bool:
    """Whether the speed is significantly different from zero, and accurate enough."""
    speed = abs(line.velocity)
    return speed > SIGMAS * line.stderr and line.stderr <= search.tolerance * speed
