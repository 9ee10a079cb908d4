"""Constant-speed stretches: found to the noise, in every rate and noise, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from stribeck.fitting.methods.stretches import Line, Search, constant_speed

SPEEDS = (0.0005, 0.0015, 0.003, 0.01, 0.05, 0.2)


def displacement(rate: float, noise: float, quantum: float) -> tuple[NDArray, NDArray]:
    """Time [s] and measured position [m] of passes of 4 s to and fro at each speed."""
    ramp, rest = int(0.1 * rate), np.zeros(int(0.5 * rate))
    level = np.concatenate(
        [np.linspace(0, 1, ramp), np.ones(int(4 * rate)), np.linspace(1, 0, ramp), rest]
    )
    velocity = np.concatenate([rest, *(s * w * level for s in SPEEDS for w in (1.0, -1.0))])
    position = np.cumsum(velocity) / rate
    position += noise * np.random.default_rng(5).standard_normal(position.size)
    if quantum:
        position = quantum * np.round(position / quantum)
    return np.arange(position.size) / rate, position


def found(time: NDArray, position: NDArray, **options: float) -> list[Line]:
    return constant_speed(time, position, np.zeros(time.size, dtype=np.int64), Search(**options))


@pytest.mark.parametrize("rate", [100.0, 1000.0])
@pytest.mark.parametrize(("noise", "quantum"), [(2e-5, 5e-6), (1e-4, 0.0), (0.0, 5e-6), (0.0, 0.0)])
def test_every_pass_is_found_once_at_its_speed(rate: float, noise: float, quantum: float) -> None:
    lines = found(*displacement(rate, noise, quantum))
    driven = [s * w for s in SPEEDS for w in (1.0, -1.0)]
    assert len(lines) == len(driven)
    for line, speed in zip(lines, driven, strict=True):
        allowed = 5.0 * line.stderr + 1e-3 * abs(speed)
        assert line.velocity == pytest.approx(speed, abs=allowed)
        assert line.rows > 0.8 * 4.0 * rate


def test_passes_without_a_rest_between_them_are_told_apart() -> None:
    time = np.arange(0.0, 40.0, 0.002)
    position = 0.3 * np.abs(time % 2.0 - 1.0)
    position += 1e-5 * np.random.default_rng(1).standard_normal(time.size)
    lines = found(time, position)
    assert len(lines) == 40
    assert {round(line.velocity, 3) for line in lines} == {0.3, -0.3}


def test_a_change_of_speed_within_one_direction_is_a_break() -> None:
    time = np.arange(0.0, 4.0, 0.005)
    position = np.where(time < 2.0, 0.1 * time, 0.2 + 0.13 * (time - 2.0))
    position += 2e-5 * np.random.default_rng(2).standard_normal(time.size)
    first, second = found(time, position)
    assert first.velocity == pytest.approx(0.10, rel=1e-3)
    assert second.velocity == pytest.approx(0.13, rel=1e-3)
    assert time[first.stop - 1] <= 2.0 <= time[second.start]


def test_no_line_crosses_a_gap() -> None:
    time = np.concatenate([np.arange(0.0, 1.0, 0.01), np.arange(5.0, 6.0, 0.01)])
    segment = np.repeat([0, 1], 100)
    lines = constant_speed(time, 0.2 * time, segment)
    assert [(line.start < 100, line.stop <= 100) for line in lines] == [
        (True, True),
        (False, False),
    ]


@pytest.mark.parametrize("seed", range(5))
def test_rest_and_noise_hold_no_pass(seed: int) -> None:
    time = np.arange(0.0, 20.0, 0.01)
    assert found(time, 1e-5 * np.random.default_rng(seed).standard_normal(time.size)) == []


def test_constant_acceleration_holds_no_pass_as_long_as_its_speed_changes() -> None:
    time = np.arange(0.0, 2.0, 0.002)
    position = 0.5 * time**2 + 1e-6 * np.random.default_rng(0).standard_normal(time.size)
    assert found(time, position, shortest=0.5) == []
