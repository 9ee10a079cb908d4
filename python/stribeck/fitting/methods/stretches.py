"""Constant-speed stretches of a displacement log: where is the position a straight line in time?

Split and merge: a line is fitted by least squares, cut at the best break into two lines where
they are better than one, and neighbours that belong to one line are joined again. Nothing is
differentiated, so that the noise of a position sensor is not raised.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.recording.rows import segment_slices

Array = NDArray[np.float64]

#: Two lines count as better than one where they lower the sum of squares by so many residual
#: variances: F(2, n) exceeds this by chance at one of 10^6 breaks.
SIGNIFICANT = 30.0
#: A residual whose squared differences sum to less than this share of its own squares is smooth.
SMOOTH = 0.5
#: Fewest rows on either side of a break.
FEWEST = 4
#: A joint moves where its speed is so many times the speed's standard error.
SIGMAS = 5.0


@dataclass(frozen=True)
class Line:
    """A straight line through the positions of the rows `start` to `stop` (exclusive).

    Attributes
    ----------
    velocity, stderr
        Slope and its standard error, in rad/s or m/s.
    time, position
        A point of the line: the means, in s and rad or m.
    rms
        Of the distances from the line, in rad or m.
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
        """Fit a line to the rows `start` to `stop` by least squares."""
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
        """Number of rows."""
        return self.stop - self.start

    def ends(self, time: Array) -> tuple[float, float]:
        """Positions on the line at its first and last row, rad or m."""
        first, last = self.at(time[[self.start, self.stop - 1]])
        return float(first), float(last)


@dataclass(frozen=True)
class Search:
    """What counts as a constant-speed stretch.

    Attributes
    ----------
    tolerance
        Largest relative difference of speed within a stretch; also the largest relative
        standard error of its speed.
    shortest
        Shortest duration of a stretch in s.
    trim
        Share of each end that is left out: what remains there of starting and stopping.
    """

    tolerance: float = 0.05
    shortest: float = 0.2
    trim: float = 0.05

    def check(self) -> None:
        """Refuse values that no stretch can meet.

        Raises
        ------
        FitError
        """
        if not 0.0 < self.tolerance < 1.0:
            raise FitError(f"--tolerance {self.tolerance:g} is out of range: give a share, 0..1")
        if not (math.isfinite(self.shortest) and self.shortest > 0.0):
            raise FitError(f"--shortest {self.shortest:g} is out of range: give seconds above 0")
        if not 0.0 <= self.trim < 0.5:
            raise FitError(f"--trim {self.trim:g} is out of range: give a share, 0 to below 0.5")


def constant_speed(
    time: Array, position: Array, segment: NDArray[np.int64], search: Search | None = None
) -> list[Line]:
    """Find the stretches in which a joint moves at constant speed.

    Parameters
    ----------
    time, position : array [n]
        In s, and rad or m as measured: noise and quantisation are what the lines average out.
    segment : int array [n]
        Number of the contiguous stretch of rows; no line crosses a gap.
    search : Search

    Returns
    -------
    list of Line
        In the order of time, trimmed. Empty where there are none.

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
    """Straight pieces of the rows `start` to `stop`, in the order of time."""
    waiting = [(start, stop)]
    while waiting:
        a, b = waiting.pop()
        if b - a < 2 * FEWEST or time[b - 1] - time[a] < search.shortest:
            continue
        at = _break(time, position, a, b, search)
        if at is None:
            yield Line.through(time, position, a, b)
        else:
            # The earlier half is taken up first.
            waiting += [(at, b), (a, at)]


def _break(time: Array, position: Array, start: int, stop: int, search: Search) -> int | None:
    """The row at which a second line begins; None where one line serves."""
    t = time[start:stop] - time[start:stop].mean()
    x = position[start:stop] - position[start:stop].mean()
    slope = float(t @ x) / float(t @ t)
    residual = x - slope * t
    left, slope_left = _growing_lines(t, x)
    right, slope_right = _growing_lines(t[::-1], x[::-1])
    # Entry k of each: the first k + 1 rows against the last n - k - 1.
    two = left[:-1] + right[::-1][1:]
    k = int(np.argmin(two[FEWEST - 1 : t.size - FEWEST])) + FEWEST - 1
    first, second = slope_left[k], slope_right[::-1][k + 1]
    differs = abs(first - second) > search.tolerance * max(abs(first), abs(second))
    fall = float(residual @ residual) - float(two[k])
    better = fall > SIGNIFICANT * max(float(two[k]), 0.0) / max(t.size - 4, 1)
    bent = _is_bent(residual, abs(slope) * float(np.sqrt(t @ t)), search)
    return start + k + 1 if (differs and better) or bent else None


def _is_bent(residual: Array, spread: float, search: Search) -> bool:
    """Whether a line misses a change of speed that two lines would miss too.

    So it is with many passes to and fro, and with a speed that rises and falls again. The latter,
    by the share p of the speed, bends the position by 0.39 p of the line's own spread; what is
    left is then smooth, where noise is rough (von Neumann's ratio is near 2).
    """
    square = float(residual @ residual)
    rough = float((np.diff(residual) ** 2).sum())
    much = square > (0.39 * search.tolerance * spread) ** 2
    return square > spread**2 or (much and rough < SMOOTH * square)


def _growing_lines(t: Array, x: Array) -> tuple[Array, Array]:
    """Sum of squares and slope of the lines through the first 1, 2, ... n rows, arrays [n]."""
    count = np.arange(1.0, t.size + 1.0)
    st, sx = np.cumsum(t), np.cumsum(x)
    tt = np.cumsum(t * t) - st * st / count
    tx = np.cumsum(t * x) - st * sx / count
    xx = np.cumsum(x * x) - sx * sx / count
    slope = np.divide(tx, tt, out=np.zeros_like(tx), where=tt > 0)
    return np.maximum(xx - slope * tx, 0.0), slope


def _merge(time: Array, position: Array, pieces: list[Line], search: Search) -> Iterator[Line]:
    """Join neighbours of which one line serves both, apart from the ends that are trimmed."""
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
    """The rows `start` to `stop` without the ends that are trimmed."""
    cut = min(int(search.trim * (stop - start)), (stop - start) // 2 - FEWEST)
    return start + cut, stop - cut


def _moves(line: Line, search: Search) -> bool:
    """Whether the speed is known well enough to be told from rest."""
    speed = abs(line.velocity)
    return speed > SIGMAS * line.stderr and line.stderr <= search.tolerance * speed
