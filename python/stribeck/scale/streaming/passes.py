"""A least-squares problem over a data set: one pass over all samples for each linearisation.

Rows are factored a window at a time and merged into the factor so far (sequential TSQR; Demmel,
Grigori, Hoemmen and Langou 2012): exact, with the condition of the Jacobian and not its square, in
memory that does not grow with the rows. Factors are kept for groups of rows, each inside a held-out
block: joined they are the blocks, and the whole; their scores tell standard errors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.rigid_body import own_load
from stribeck.identify.problem import Problem
from stribeck.identify.triangle import Triangle, triangles
from stribeck.models.model import Model
from stribeck.scale.streaming.runs import numbered
from stribeck.scale.streaming.windows import Window, Windows

__all__ = ["Groups", "StreamedProblem", "Told", "group_edges"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Called after each window with samples done, samples in all, and the number of the pass.
Told = Callable[[int, int, int], None]


def group_edges(edges: Ints, count: int) -> Ints:
    """Rows at which groups begin, `count` in each held-out block, and the number of all rows."""
    shares = np.arange(count) / count
    first = edges[:-1, None] + np.diff(edges)[:, None] * shares
    return np.append(np.unique(first.astype(np.int64)), edges[-1])


@dataclass(frozen=True)
class Groups:
    """Result of a pass: the problem linearised at `values`, in groups of samples.

    Attributes
    ----------
    values, wanted
        Where it was linearised, array [p], and by which parameters, array [k].
    parts, number
        Factors of each group that has rows, and its number among all.
    rows
        Rows of each group that are fitted to, array [groups].
    ranges
        Least and largest value of each channel over these rows.
    torque_square
        Sum of squares of the measured torque over them.
    time_span
        Times of the first and of the last row, s.
    count, dropped
        Rows in all that were read, and those without a number.
    """

    values: Array
    wanted: NDArray[np.intp]
    parts: list[Triangle]
    number: Ints
    rows: Ints
    ranges: dict[str, tuple[float, float]]
    torque_square: float
    time_span: tuple[float, float]
    count: int
    dropped: int

    def moved(self, values: Array) -> list[Triangle]:
        """Factors at other values of parameters in which the torque is linear."""
        step = (values - self.values)[self.wanted]
        return [Triangle(t.factor, t.right - t.factor @ step, t.rest) for t in self.parts]


class _Sums:
    """What a pass has gathered so far."""

    def __init__(self, values: Array, wanted: NDArray[np.intp], edges: Ints) -> None:
        self.values, self.wanted, self.edges = values, wanted, edges
        empty = Triangle(np.zeros((wanted.size,) * 2), np.zeros(wanted.size), 0.0)
        self.parts = [empty] * (edges.size - 1)
        self.rows = np.zeros(edges.size - 1, dtype=np.int64)
        self.ranges: dict[str, tuple[float, float]] = {}
        self.torque_square = 0.0
        self.times: list[float] = []
        self.count = self.dropped = 0

    def add(self, window: Window, problem: Problem, residual: Array, jacobian: Array) -> None:
        """Take in a window, linearised on its rows [m]: residual [m] and jacobian [m, k]."""
        time = window.recording.time
        self.times = [*self.times[:1], float(time[0]), float(time[-1])]
        self.count += window.count
        self.dropped += window.dropped
        if window.rows.size == 0:
            return
        self.torque_square += float(problem.target @ problem.target)
        _widen(self.ranges, operating_box(problem.model, window.recording, problem.load))
        group = numbered(window.row[window.rows], self.edges[:-1])
        first, last = int(group[0]), int(group[-1]) + 1
        own = (group - first).astype(np.uint32)
        for k, part in enumerate(triangles(jacobian, residual, own, last - first), start=first):
            self.parts[k] = part if self.rows[k] == 0 else Triangle.joined([self.parts[k], part])
        self.rows[first:last] += np.bincount(own, minlength=last - first)

    def done(self) -> Groups:
        """The groups of which there is something."""
        full = np.flatnonzero(self.rows)
        return Groups(
            self.values,
            self.wanted,
            [self.parts[k] for k in full],
            full,
            self.rows[full],
            self.ranges,
            self.torque_square,
            (self.times[0], self.times[-1]),
            self.count,
            self.dropped,
        )


@dataclass
class StreamedProblem:
    """A model on a data set, for `stribeck.identify.separable`.

    Parameters
    ----------
    load_at : array [p] or None
        Values whose rigid body gives the load that friction depends on, where no column does.
    edges : array [groups + 1]
        Rows at which groups begin.
    told
        Told after each window.
    """

    windows: Windows
    model: Model
    edges: Ints
    told: Told
    load_at: Array | None = None
    passes: int = field(default=0, init=False)
    latest: Groups | None = field(default=None, init=False)

    @property
    def torque_norm(self) -> float:
        """Norm of the measured torque over the rows that are fitted to."""
        assert self.latest is not None
        return float(np.sqrt(self.latest.torque_square))

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """The problem linearised at `values`, its columns times `slope` [k]; one pass."""
        made = self.groups(values, wanted)
        if made is None:
            return None
        whole = Triangle.joined(made.parts)
        scaled = Triangle(whole.factor * slope, whole.right, whole.rest)
        finite = np.isfinite(scaled.square) and np.all(np.isfinite(scaled.factor))
        return scaled if finite else None

    def groups(self, values: Array, wanted: NDArray[np.intp]) -> Groups | None:
        """Linearise at `values` by the parameters `wanted`, all rows; None where not finite."""
        sums = _Sums(values, wanted, self.edges)
        self.passes += 1
        for window in self.windows:
            problem = self._problem(window)
            with np.errstate(all="ignore"):
                residual, jacobian = problem.linearise(values, wanted)
            if not (np.all(np.isfinite(residual)) and np.all(np.isfinite(jacobian))):
                return None
            sums.add(window, problem, residual, jacobian)
            self.told(window.end, self.windows.data.rows, self.passes)
        if not sums.rows.any():
            raise FitError(f"{self.windows.data.path}: no row of the data set moves")
        self.latest = sums.done()
        return self.latest

    def _problem(self, window: Window) -> Problem:
        load = None
        if self.load_at is not None:
            load = own_load(self.model.with_values(self.load_at), window.recording)
        return Problem(window.recording, self.model, window.rows, load)


def _widen(ranges: dict[str, tuple[float, float]], seen: dict[str, tuple[float, float]]) -> None:
    """Let ranges hold what was seen too."""
    for name, (low, high) in seen.items():
        if np.isfinite(low) and np.isfinite(high):
            before = ranges.get(name, (low, high))
            ranges[name] = (min(before[0], low), max(before[1], high))
