"""Point-to-point motions: quintic moves at all speeds, forward and back, with rests between."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.motion.design.motion import INSIDE, Limits, SampledMotion, sample_times
from stribeck.motion.generate.trajectory import quintic

Array = NDArray[np.float64]

#: Peak speed and acceleration of a quintic move over unit distance in unit time.
PEAK_SPEED, PEAK_ACCELERATION = 1.875, 10.0 / math.sqrt(3.0)
#: Range of the lengths of moves and of their durations, in decades.
DECADES, TIME_DECADES = 2.5, 1.5
#: Smallest mean duration of a move, s; largest number of moves in each direction.
SECONDS_A_MOVE, MOST_MOVES = 2.0, 8
#: Rest after each move, s, and the share of the time that rests may take.
REST, REST_SHARE = 0.2, 0.1


@dataclass(frozen=True)
class PassMotions:
    """Moves between way points for `duration` s, then all of them back in reverse order.

    Each move is made once in both directions at the same speed. The design vector contains the
    length of each move (logarithmic; below 0.5 backward), its share of the time, and the start
    position.
    """

    limits: Limits
    duration: float
    name: str = "point-to-point moves"

    @property
    def moves(self) -> int:
        """Number of moves in each direction."""
        return int(np.clip(self.duration / (2.0 * SECONDS_A_MOVE), 1, MOST_MOVES))

    @property
    def variables(self) -> int:
        """Two variables per move, and the start position."""
        return 2 * self.moves + 1

    @property
    def start(self) -> Array:
        """Alternating fast and slow moves from the middle of the range."""
        way = np.resize([1.0, 0.0, 0.85, 0.15], self.moves)
        share = np.resize([0.5, 0.2, 0.8], self.moves)
        return np.concatenate([way, share, [0.5]])

    def motion(self, design: Array, rate: float) -> SampledMotion:
        """Return the motion of a design vector [variables], sampled at `rate` in Hz."""
        rest = min(REST, REST_SHARE * self.duration / (2.0 * self.moves))
        seconds = self._seconds(design[self.moves : -1], 0.5 * self.duration - self.moves * rest)
        points = self._points(design[: self.moves], seconds, design[-1])
        points = np.concatenate([points, points[-2::-1]])
        seconds = np.concatenate([seconds, seconds[::-1]])
        starts = np.concatenate([[0.0], np.cumsum(seconds + rest)[:-1]])
        time = sample_times(self.duration, rate)
        move = np.maximum(np.searchsorted(starts, time, side="right") - 1, 0)
        way, speed, bend = quintic(np.clip((time - starts[move]) / seconds[move], 0.0, 1.0))
        span = np.diff(points)[move]
        q = np.clip(points[move] + span * way, self.limits.low, self.limits.high)
        return SampledMotion(
            time, q, span * speed / seconds[move], span * bend / seconds[move] ** 2
        )

    def _seconds(self, shares: Array, available: float) -> Array:
        """Duration of each move, s, array [moves]."""
        weights = 10.0 ** (TIME_DECADES * shares)
        return np.asarray(available * weights / weights.sum())

    def _points(self, ways: Array, seconds: Array, start: float) -> Array:
        """Way points, array [moves + 1]; moves are shortened to stay within the limits."""
        limits = self.limits
        longest = INSIDE * np.minimum(
            limits.speed * seconds / PEAK_SPEED,
            limits.acceleration * seconds**2 / PEAK_ACCELERATION,
        )
        at = limits.low + limits.stroke * start
        points = [at]
        for way, most in zip(2.0 * ways - 1.0, longest, strict=True):
            length = min(limits.stroke * 10.0 ** (DECADES * (abs(way) - 1.0)), most)
            room = (at - limits.low, limits.high - at)
            forward = bool(way >= 0.0)
            if length > room[forward]:
                forward = bool(room[1] > room[0])
            at += (1.0 if forward else -1.0) * min(length, room[forward])
            at = min(max(at, limits.low), limits.high)
            points.append(at)
        return np.array(points)
