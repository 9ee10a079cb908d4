"""The moves of a recording: stretches of motion that are independent observations.

A move speeds up and slows down. It ends at a reversal, a stop or a gap, or where the speed falls to
less than half of what it is before and after. A joint that turns on at one speed begins a new pass
with each turn. Each steady-state point is a move.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stribeck.recording.arrays import Floats, Ints, ints
from stribeck.recording.recording import Recording

#: A dip of the speed below this share of the peaks on both sides ends a move.
DIP = 0.5


def moves(recording: Recording) -> Ints:
    """The move of each sample, int array [n], counted from 0; -1 where the joint is at rest.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 6.0, 0.01)
    >>> v = np.sin(2 * np.pi * t / 2)
    >>> r = Recording.from_columns(time=t, velocity=v, torque=np.ones(t.size))
    >>> int(moves(r).max()) + 1
    6
    """
    if "moves" not in recording.kept:
        recording.kept["moves"] = ints(_counted(recording))
    return recording.kept["moves"]


def _counted(recording: Recording) -> Ints:
    """The move of each sample, counted."""
    move = np.full(recording.time.size, -1, dtype=np.intp)
    at = np.flatnonzero(recording.moving)
    if at.size == 0:
        return move
    if recording.averaged:
        move[at] = np.arange(at.size)
        return move
    velocity = recording.denoised("velocity")[at]
    new = np.concatenate([[True], np.sign(velocity[1:]) != np.sign(velocity[:-1])])
    # Rest, a gap or another run between two moving samples.
    new[1:] |= (np.diff(at) > 1) | (np.diff(recording.segment[at]) != 0)
    starts = [int(k) for k in np.flatnonzero(new)]
    ends = [*starts[1:], at.size]
    for start, end in zip(starts, ends, strict=True):
        new[start + np.array(_dips(np.abs(velocity[start:end])), dtype=np.intp)] = True
    move[at] = np.cumsum(new) - 1 + _turns(recording, at, new)
    _, move[at] = np.unique(move[at], return_inverse=True)
    return move


def _dips(speed: Floats) -> list[int]:
    """Where the speed is least between two peaks that are higher than it by 1 / `DIP`."""
    found: list[int] = []
    low = 0
    peak, risen = speed[0], True
    for k in range(1, speed.size):
        s = speed[k]
        if risen:
            peak = max(peak, s)
            if s < DIP * peak:
                risen, low = False, k
        elif s < speed[low]:
            low = k
        elif speed[low] < DIP * s:
            found.append(low)
            risen, peak = True, s
    return found


def _turns(recording: Recording, at: NDArray[np.intp], new: NDArray[np.bool_]) -> Ints:
    """Whole turns of a joint that turns on, counted over all its moves, int array [m]."""
    if recording.position is None or recording.joint_kind != "revolute":
        return np.zeros(at.size, dtype=np.intp)
    position = recording.position[at]
    first = np.maximum.accumulate(np.where(new, np.arange(at.size), 0))
    turned = np.floor(np.abs(position - position[first]) / (2.0 * math.pi)).astype(np.intp)
    passed = np.maximum(np.diff(turned, prepend=0), 0)
    return np.cumsum(np.where(new, 0, passed))


def directions(recording: Recording) -> Ints:
    """The direction of motion of each sample, int array [n] of 1 and -1.

    Between two moving samples the velocity without noise tells it, if its sign changes at most
    once. Otherwise the joint is at rest there: the direction is that of the nearest moving sample.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(0.0, 1.0, 0.1)
    >>> v = np.array([-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    >>> r = Recording.from_columns(time=t, velocity=v, torque=np.ones(t.size))
    >>> directions(r).tolist()
    [-1, -1, -1, -1, -1, 1, 1, 1, 1, 1]
    """
    if "directions" not in recording.kept:
        recording.kept["directions"] = ints(_directed(recording))
    return recording.kept["directions"]


def _directed(recording: Recording) -> Ints:
    """The direction of motion of each sample, found."""
    sign = np.where(recording.velocity < 0.0, -1, 1)
    at, rows = np.flatnonzero(recording.moving), np.arange(sign.size)
    if at.size == 0:
        return sign
    place = np.searchsorted(at, rows)
    before, after = at[np.maximum(place - 1, 0)], at[np.minimum(place, at.size - 1)]
    nearest = sign[np.where(np.abs(after - rows) < np.abs(rows - before), after, before)]
    smooth = np.sign(recording.denoised("velocity")).astype(np.intp)
    seen = np.where(recording.moving, sign, smooth)
    changes = np.cumsum(np.diff(seen, prepend=seen[0]) != 0)
    passed = (before < rows) & (rows < after) & (changes[after] - changes[before] <= 1)
    return np.where(passed, seen, nearest)


def move_seconds(recording: Recording) -> float:
    """Median duration of a move in s, weighted by duration; 0 without motion."""
    move = moves(recording)
    inside = move >= 0
    if not inside.any():
        return 0.0
    lasted = np.bincount(move[inside], recording.dt[inside])
    longest = np.sort(lasted)
    half = np.searchsorted(np.cumsum(longest), 0.5 * longest.sum())
    return float(longest[min(int(half), longest.size - 1)])
