"""A least-squares problem over a data set: one pass over all samples for each linearisation.

Each window is factored and merged into the factor so far (sequential TSQR; Demmel, Grigori, Hoemmen
and Langou 2012). This is exact, has the condition number of the Jacobian and not its square, and
needs memory independent of the number of samples. Factors are stored for groups of samples within a
held-out block. Joined, they give the factors of the blocks and of all samples; their scores give
standard errors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.operating_box import operating_box
from stribeck.identify.problem import Problem
from stribeck.identify.triangle import Triangle, triangles
from stribeck.models.model import Model
from stribeck.models.rigid_body import own_load
from stribeck.scale.streaming.runs import numbered
from stribeck.scale.streaming.windows import Window, Windows

__all__ = ["Groups", "StreamedProblem", "Told", "group_edges"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Called after each window with the samples done, all samples, and the number of the pass.
Told = Callable[[int, int, int], None]


def group_edges(edges: Ints, count: int) -> Ints:
    """First samples of the groups, `count` in each held-out block; then the number of samples."""
    shares = np.arange(count) / count
    first = edges[:-1, None] + np.diff(edges)[:, None] * shares
    return np.append(np.unique(first.astype(np.int64)), edges[-1])


@dataclass(frozen=True)
class Groups:
    """Result of a pass: the problem linearised at `values`, in groups of samples.

    Attributes
    ----------
    values, wanted
        Point of linearisation, array [p], and indices of the free parameters, array [k].
    parts, number
        Factor of each group with samples, and the index of the group.
    rows
        Number of fitted samples of each group, array [groups].
    ranges
        Smallest and largest value of each channel over these samples.
    torque_square
        Sum of squares of the measured torque over these samples.
    time_span
        Times of the first and the last of these samples, s.
    count, dropped
        Number of samples read, and of samples dropped as not finite.
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
        """Return the factors at other values of the linear parameters."""
        step = (values - self.values)[self.wanted]
        return [Triangle(t.factor, t.right - t.factor @ step, t.rest) for t in self.parts]


class _Sums:
    """Sums accumulated during a pass."""

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
        """Add a window linearised at its m samples: residual [m] and jacobian [m, k]."""
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
        """Return the groups that have samples."""
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
    """A model on a data set, for `stribeck.identify.search.separable`.

    Parameters
    ----------
    load_at : array [p] or None
        Parameter values whose rigid body gives the load of the friction law, if no column does.
    edges : array [groups + 1]
        First samples of the groups, then the number of all samples.
    told
        Called after each window.
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
        """Norm of the measured torque over the fitted samples."""
        assert self.latest is not None
        return float(np.sqrt(self.latest.torque_square))

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """Linearise at `values` in one pass, with the columns scaled by `slope` [k]."""
        made = self.groups(values, wanted)
        if made is None:
            return None
        whole = Triangle.joined(made.parts)
        scaled = Triangle(whole.factor * slope, whole.right, whole.rest)
        finite = np.isfinite(scaled.square) and np.all(np.isfinite(scaled.factor))
        return scaled if finite else None

    def groups(self, values: Array, wanted: NDArray[np.intp]) -> Groups | None:
        """Linearise all samples at `values` in the parameters `wanted`; None if not finite."""
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
            raise FitError(f"{self.windows.data.path}: no sample of the data set moves")
        self.latest = sums.done()
        return self.latest

    def _problem(self, window: Window) -> Problem:
        load = None
        if self.load_at is not None:
            load = own_load(self.model.with_values(self.load_at), window.recording)
        return Problem(window.recording, self.model, window.rows, load)


def _widen(ranges: dict[str, tuple[float, float]], seen: dict[str, tuple[float, float]]) -> None:
    """Extend ranges to include those of `seen`."""
    for name, (low, high) in seen.items():
        if np.isfinite(low) and np.isfinite(high):
            before = ranges.get(name, (low, high))
            ranges[name] = (min(before[0], low), max(before[1], high))
