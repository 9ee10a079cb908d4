"""Joint trajectories through way points: trapezoidal speed or quintic polynomials."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: Position of a unit move and its first two derivatives, as functions of unit time.
Profile = Callable[[Array], tuple[Array, Array, Array]]


@dataclass(frozen=True)
class Limits:
    """Limits of every joint: rad/s and rad/s2."""

    speed: float
    acceleration: float


@dataclass(frozen=True)
class Trajectory:
    """Moves from rest to rest between way points; all joints start and stop together.

    Attributes
    ----------
    points
        Way points, rad, array [moves + 1, joints].
    durations
        Durations of the moves, s, array [moves].
    dwell
        Rest after each move, s.
    profiles
        Profile of each move.
    """

    points: Array
    durations: Array
    dwell: float
    profiles: tuple[Profile, ...]

    @property
    def seconds(self) -> float:
        """Duration in s, rests included."""
        return float(self.durations.sum() + self.dwell * self.durations.size)

    def __call__(self, time: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration at `time` [s], arrays [n, joints]."""
        starts = np.concatenate([[0.0], np.cumsum(self.durations + self.dwell)])[:-1]
        move = np.maximum(np.searchsorted(starts, time, side="right") - 1, 0)
        share = np.clip((time - starts[move]) / self.durations[move], 0.0, 1.0)
        way, speed, bend = np.empty_like(time), np.empty_like(time), np.empty_like(time)
        for k, profile in enumerate(self.profiles):
            rows = move == k
            way[rows], speed[rows], bend[rows] = profile(share[rows])
        span = np.diff(self.points, axis=0)[move]
        duration = self.durations[move, None]
        return (
            self.points[move] + span * way[:, None],
            span * speed[:, None] / duration,
            span * bend[:, None] / duration**2,
        )


def trapezoid(ramp: float) -> Profile:
    """Constant acceleration, cruise, constant deceleration; `ramp` is the share of each ramp."""

    def profile(share: Array) -> tuple[Array, Array, Array]:
        top = 1.0 / (1.0 - ramp)
        left = 1.0 - share
        rising, falling = share < ramp, left < ramp
        resting = (share <= 0.0) | (left <= 0.0)
        up, down = 0.5 * top * share**2 / ramp, 1.0 - 0.5 * top * left**2 / ramp
        way = np.where(rising, up, np.where(falling, down, top * (share - 0.5 * ramp)))
        speed = top * np.minimum(np.minimum(share, left) / ramp, 1.0)
        bend = np.where(resting, 0.0, np.where(rising, 1.0, np.where(falling, -1.0, 0.0)))
        return way, speed, bend * top / ramp

    return profile


def quintic(share: Array) -> tuple[Array, Array, Array]:
    """Fifth-degree polynomial with speed and acceleration zero at both ends."""
    x = share
    return (
        x**3 * (10.0 - 15.0 * x + 6.0 * x**2),
        30.0 * x**2 * (1.0 - x) ** 2,
        60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    )


def way_points(
    rng: np.random.Generator, lower: Array, upper: Array, count: int, least: float
) -> Array:
    """Draw points, each at least `least` rad from the previous one in some joint."""
    points = [rng.uniform(lower, upper)]
    while len(points) < count:
        drawn = rng.uniform(lower, upper)
        if np.abs(drawn - points[-1]).max() >= least:
            points.append(drawn)
    return np.array(points)


def trapezoidal_trajectory(points: Array, limits: Limits, dwell: float) -> Trajectory:
    """Moves between `points` as fast as the limits allow, with some joint at its limit."""
    ways = np.abs(np.diff(points, axis=0)).max(axis=1)
    ramps = np.minimum(limits.speed / limits.acceleration, np.sqrt(ways / limits.acceleration))
    durations = ramps + ways / (limits.acceleration * ramps)
    profiles = tuple(
        trapezoid(float(ramp / duration)) for ramp, duration in zip(ramps, durations, strict=True)
    )
    return Trajectory(points, durations, dwell, profiles)


def quintic_trajectory(
    rng: np.random.Generator, points: Array, limits: Limits, dwell: float, seconds: float
) -> Trajectory:
    """Moves between `points` in `seconds`, some close to the limits and some much slower."""
    ways = np.abs(np.diff(points, axis=0)).max(axis=1)
    peak_speed, peak_acceleration = 1.875, 10.0 / math.sqrt(3.0)
    fastest = np.maximum(
        peak_speed * ways / limits.speed,
        np.sqrt(peak_acceleration * ways / limits.acceleration),
    )
    slower = rng.uniform(0.0, 1.0, ways.size) * fastest
    spare = seconds - dwell * ways.size - fastest.sum()
    if spare < 0.0:
        raise ValueError(f"{ways.size} moves do not fit into {seconds:g} s")
    durations = fastest + spare / slower.sum() * slower
    return Trajectory(points, durations, dwell, (quintic,) * ways.size)
