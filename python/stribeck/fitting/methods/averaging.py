"""Friction without a gravity model: half the difference of a forward and a backward pass.

Bittencourt et al. 2010, eqs 3-4. At constant speed over the same positions the load torque is the
same in both directions: it cancels in the difference, and half the sum is the load torque.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError
from stribeck.fitting.methods.segments import check_bins, constant_stretches
from stribeck.fitting.methods.steady import SteadyPoint, SteadyPoints, checked_points, mean_of
from stribeck.fitting.methods.stretches import Line, Search
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

Array = NDArray[np.float64]

#: Least share of the shorter pass that the other one covers.
COVERED = 0.5


@dataclass(frozen=True)
class Pair:
    """A forward and a backward pass, and the positions that both cover, in rad or m."""

    forward: Line
    backward: Line
    low: float
    high: float


def averaged_points(
    recording: Recording, *, bins: int = 1, search: Search | None = None
) -> SteadyPoints:
    """Steady-state friction points from passes at constant speed in both directions.

    The method assumes friction that does not depend on direction (Bittencourt et al. 2010, eq 4):
    half the difference is the mean of both directions, and an offset is part of the load.

    Parameters
    ----------
    recording : Recording
        With a measured position. Its load torque, if any, is not used.
    bins : int
        Points per pair of passes, each over an equal share of the positions: with gravity their
        load torques differ.
    search : Search, optional
        Criteria of constant speed; passes are paired if their speeds agree to its tolerance.

    Returns
    -------
    SteadyPoints
        With velocity > 0, friction (u+ - u-)/2 and load torque (u+ + u-)/2.

    Raises
    ------
    FitError
        No position; no passes at constant speed; no pair of passes.

    Examples
    --------
    >>> points = averaged_points(sb.read("joint2.parquet"), bins=10)  # doctest: +SKIP
    >>> points.write("points.csv")  # doctest: +SKIP

    On the command line: ``stribeck fit points.csv --model m1 --method grid``.
    """
    refuse_weights("a reduction to points", recording)
    check_bins(bins)
    search = search or Search()
    lines = constant_stretches(recording, search)
    pairs = list(_pairs(lines, recording.time, search))
    if not pairs:
        forward = sum(line.velocity > 0 for line in lines)
        raise FitError(
            f"{recording.path} has {forward} forward and {len(lines) - forward} backward passes at "
            f"constant speed, but no two at the same speed over the same positions: record each "
            f"speed in both directions"
        )
    points = [point for pair in pairs for point in _points(recording, pair, bins)]
    alone = len(lines) - 2 * len(pairs)
    notes = [f"{len(pairs)} pairs of passes; friction is taken as the same in both directions"]
    if alone:
        left_out = "pass has" if alone == 1 else "passes have"
        notes.append(f"{alone} {left_out} no counterpart in the other direction: left out")
    return checked_points(points, recording, "averaging", notes)


def _pairs(lines: Sequence[Line], time: Array, search: Search) -> Iterator[Pair]:
    """Each forward pass with the nearest backward pass in time that matches, each used once."""
    backward = [line for line in lines if line.velocity < 0]
    for one in (line for line in lines if line.velocity > 0):
        for other in sorted(backward, key=lambda line: abs(line.time - one.time)):
            pair = _paired(one, other, time, search)
            if pair is not None:
                backward.remove(other)
                yield pair
                break


def _paired(one: Line, other: Line, time: Array, search: Search) -> Pair | None:
    """The two passes as a pair; None if their speeds or positions differ."""
    if abs(one.velocity + other.velocity) > search.tolerance * one.velocity:
        return None
    low_one, high_one = one.ends(time)
    high_other, low_other = other.ends(time)
    low, high = max(low_one, low_other), min(high_one, high_other)
    shorter = min(high_one - low_one, high_other - low_other)
    return Pair(one, other, low, high) if high - low >= COVERED * shorter else None


def _points(recording: Recording, pair: Pair, bins: int) -> Iterator[SteadyPoint]:
    """Points of a pair, one per bin of positions."""
    rows = max(pair.forward.rows, pair.backward.rows)
    grid = np.linspace(pair.low, pair.high, rows)
    plus = _torque_at(recording, pair.forward, grid)
    minus = _torque_at(recording, pair.backward, grid)
    velocity = 0.5 * (pair.forward.velocity - pair.backward.velocity)
    stderr = 0.5 * float(np.hypot(pair.forward.stderr, pair.backward.stderr))
    first, last = sorted((pair.forward, pair.backward), key=lambda line: line.start)
    for part in np.array_split(np.arange(rows), min(bins, rows)):
        friction, error = mean_of(0.5 * (plus[part] - minus[part]))
        yield SteadyPoint(
            start=float(recording.time[first.start]),
            stop=float(recording.time[last.stop - 1]),
            rows=2 * part.size,
            velocity=velocity,
            velocity_stderr=stderr,
            friction_torque=friction,
            friction_stderr=error,
            load_torque=float(0.5 * (plus[part] + minus[part]).mean()),
            temperature=_mean_temperature(recording, pair),
        )


def _torque_at(recording: Recording, line: Line, grid: Array) -> Array:
    """Torque of a pass at the positions `grid`, array [len(grid)].

    Positions are those of the pass's line, which is monotonic where noisy samples may not be.
    """
    rows = slice(line.start, line.stop)
    along = line.at(recording.time[rows])
    order = slice(None) if line.velocity > 0 else slice(None, None, -1)
    return np.interp(grid, along[order], recording.torque[rows][order])


def _mean_temperature(recording: Recording, pair: Pair) -> float | None:
    if recording.temperature is None:
        return None
    passes = (pair.forward, pair.backward)
    return float(np.mean([recording.temperature[line.start : line.stop].mean() for line in passes]))
