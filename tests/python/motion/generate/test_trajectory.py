"""Trajectories: derivatives belong together, limits hold, way points are met."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.motion.generate.trajectory import (
    Limits,
    Trajectory,
    quintic_trajectory,
    trapezoidal_trajectory,
    way_points,
)

LIMITS = Limits(speed=3.0, acceleration=4.0)


def made(kind: str, seed: int) -> Trajectory:
    rng = np.random.default_rng(seed)
    points = way_points(rng, np.full(3, -2.5), np.full(3, 2.5), 6, 2.6)
    if kind == "quintic":
        return quintic_trajectory(rng, points, LIMITS, 0.25, 25.0)
    return trapezoidal_trajectory(points, LIMITS, 0.25)


@pytest.mark.parametrize("kind", ["quintic", "trapezoidal"])
@pytest.mark.parametrize("seed", range(3))
def test_derivatives_belong_to_the_position(kind: str, seed: int) -> None:
    trajectory = made(kind, seed)
    t = np.arange(0.0, trajectory.seconds, 1e-4)
    q, v, a = trajectory(t)
    assert np.abs(np.gradient(q, t, axis=0) - v).max() < 1e-3
    # A trapezoid's acceleration jumps: there the difference is half of the jump.
    assert np.quantile(np.abs(np.gradient(v, t, axis=0) - a), 0.99) < 1e-2
    assert np.abs(v).max() <= LIMITS.speed * (1 + 1e-9)
    assert np.abs(a).max() <= LIMITS.acceleration * (1 + 1e-9)


@pytest.mark.parametrize("kind", ["quintic", "trapezoidal"])
def test_way_points_are_met_at_rest(kind: str) -> None:
    trajectory = made(kind, 1)
    ends = np.cumsum(trajectory.durations + trajectory.dwell) - 0.5 * trajectory.dwell
    q, v, a = trajectory(ends)
    np.testing.assert_allclose(q, trajectory.points[1:], atol=1e-12)
    assert np.abs(v).max() < 1e-12 and np.abs(a).max() < 1e-12


def test_each_trapezoidal_move_reaches_the_largest_speed() -> None:
    trajectory = made("trapezoidal", 2)
    starts = np.cumsum(trajectory.durations + trajectory.dwell) - trajectory.dwell
    _, v, _ = trajectory(starts - 0.5 * trajectory.durations)
    np.testing.assert_allclose(np.abs(v).max(axis=1), LIMITS.speed, rtol=1e-9)


def test_a_quintic_trajectory_lasts_as_long_as_asked() -> None:
    assert made("quintic", 3).seconds == pytest.approx(25.0, rel=1e-12)
    with pytest.raises(ValueError, match="do not fit"):
        points = np.array([[0.0], [2.0], [0.0]])
        quintic_trajectory(np.random.default_rng(0), points, LIMITS, 0.2, 1.0)
