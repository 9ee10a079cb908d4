"""Moves end at reversals, stops, gaps and deep dips of the speed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.recording.motion.moves import move_seconds, moves
from synthetic import joint, record

T = np.arange(0.0, 20.0, 0.01)


def turned(folder: Path, velocity: np.ndarray) -> sb.Recording:
    frame = pl.DataFrame(
        {
            "time": T,
            "position": np.cumsum(velocity) * 0.01,
            "velocity": velocity,
            "torque": 1.0 + 0.1 * velocity,
        }
    )
    return record(folder, frame, trust=True)


def count(recording: sb.Recording) -> int:
    return int(moves(recording).max()) + 1


def test_a_reversal_ends_a_move(tmp_path: Path) -> None:
    recording = turned(tmp_path, np.sin(2.0 * np.pi * T / 4.0) + 1e-6)
    assert count(recording) == 10
    assert move_seconds(recording) == pytest.approx(2.0, abs=0.05)


def test_a_dip_to_less_than_half_ends_a_move_and_a_shallow_one_does_not(tmp_path: Path) -> None:
    wave = np.cos(2.0 * np.pi * T / 4.0)
    assert count(turned(tmp_path, 0.1 + 0.04 * wave)) == 6
    assert count(turned(tmp_path, 0.1 + 0.02 * wave)) == 1


def test_each_turn_of_a_joint_that_turns_on_is_a_pass(tmp_path: Path) -> None:
    assert count(turned(tmp_path, np.full(T.size, np.pi))) == 10


def test_rest_is_no_move_and_steady_points_are_one_each(tmp_path: Path) -> None:
    resting = turned(tmp_path, np.where((T > 5.0) & (T < 8.0), 0.0, 0.3))
    assert set(moves(resting)[(T > 5.5) & (T < 7.5)]) == {-1}
    assert count(resting) == 2
    points = record(tmp_path, joint(rows=40), "points", average="row")
    assert count(points) == int(points.moving.sum())
