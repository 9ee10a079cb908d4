"""The low-pass of an acceleration: over whole segments, or over each motion by itself."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.recording.acceleration_filter import AccelerationFilter, Derivable, filter_text

#: A speed that rises at 2 per second, rests, and falls at 3 per second, 200 samples a second.
TIME = np.arange(1200) / 200.0
SPEED = np.where(TIME < 2.0, 2.0 * (TIME - 2.0), np.where(TIME > 4.0, 3.0 * (TIME - 4.0), 0.0))
ACCELERATION = np.where(TIME < 2.0, 2.0, np.where(TIME > 4.0, 3.0, 0.0))
SEGMENT = np.zeros(TIME.size, dtype=np.int64)


def derived(chosen: AccelerationFilter) -> np.ndarray:
    return chosen.derived(Derivable(TIME, SEGMENT, SPEED, 1, SPEED))


@pytest.mark.parametrize("at_ends", [10.0, 20.0])
def test_a_jump_stays_a_jump(at_ends: float) -> None:
    apart = derived(AccelerationFilter(10.0, at_ends, still=1e-6))
    beside = (np.abs(TIME - 2.0) < 0.1) | (np.abs(TIME - 4.0) < 0.1)
    # The sample at which the joint stops belongs to the rest.
    away = np.abs(TIME - 2.0) > 0.01
    assert np.abs(apart - ACCELERATION)[away].max() < 0.02
    assert np.abs(derived(AccelerationFilter(10.0)) - ACCELERATION)[beside & away].max() > 0.5


def test_short_motions_are_filtered_as_a_whole() -> None:
    # Of a filter at 0.5 Hz no motion here lasts two periods.
    whole, apart = derived(AccelerationFilter(0.5)), derived(AccelerationFilter(0.5, 0.5, 1e-6))
    np.testing.assert_allclose(apart, whole, rtol=1e-12, atol=1e-12)


def test_the_cutoff_rises_towards_the_ends() -> None:
    rng = np.random.default_rng(1)
    noisy = SPEED + 0.01 * rng.standard_normal(SPEED.size)
    made = AccelerationFilter(5.0, 20.0, 0.05).derived(Derivable(TIME, SEGMENT, noisy, 1, SPEED))
    error = np.abs(made - ACCELERATION)
    inside = (TIME > 0.5) & (TIME < 1.5)
    ends = (TIME > 1.85) & (TIME < 1.95)
    assert np.sqrt(np.mean(error[inside] ** 2)) < 0.5 * np.sqrt(np.mean(error[ends] ** 2))


def test_what_is_said() -> None:
    assert filter_text(None).startswith("no filter")
    assert AccelerationFilter(12.0).text() == "zero-phase low-pass at 12 Hz chosen from the data"
    assert AccelerationFilter(12.0, 24.0).text().endswith("by itself, 24 Hz beside its ends")
    assert AccelerationFilter(12.0, 12.0).text().endswith("over each motion by itself")
