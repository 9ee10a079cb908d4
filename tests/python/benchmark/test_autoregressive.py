"""Recordings for the coverage of intervals: noise with memory, and what it does to intervals."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.benchmark.cases import cases
from stribeck.benchmark.coverage import autoregressive_recording, intervals
from stribeck.benchmark.run import run


@pytest.mark.parametrize("correlation", [0.0, 0.9, 0.99])
def test_the_noise_remembers_as_it_should(correlation: float) -> None:
    frame, truth = autoregressive_recording("coulomb", 1, correlation)
    v = frame["velocity"].to_numpy()
    moving = np.abs(v) > 0.05 * np.abs(v).max()
    friction = truth["coulomb_friction"] * np.sign(v) + truth["viscous_friction"] * v
    noise = (frame["torque"] - frame["load_torque"]).to_numpy() - friction
    both = moving[1:] & moving[:-1]
    rho = np.corrcoef(noise[1:][both], noise[:-1][both])[0, 1]
    # Velocity noise adds a trace of white noise.
    assert rho == pytest.approx(correlation, abs=0.03)


def test_both_kinds_of_interval_are_looked_at() -> None:
    made = intervals("coulomb", 2, 0.99)
    assert [i.parameter for i in made] == ["coulomb_friction", "viscous_friction"]
    for interval in made:
        # Rows that repeat each other make ordinary intervals far too short.
        assert interval.width > 3 * interval.width_ordinary > 0
    curved = intervals("stribeck", 3, 0.0)
    assert len(curved) == 5
    assert all(i.covers_ordinary is None for i in curved)
    assert all(i.covers_profile is not None for i in [*made, *curved])


@pytest.mark.long
def test_intervals_cover_the_truth() -> None:
    """Robust and profile intervals, in 200 recordings for each correlation of the noise."""
    answers, found = run(cases(10, only="coverage"), None)
    assert len(answers) == 600 and not found.failures
    for line in found.coverage:
        assert line.recordings == 200 and line.profile.total == line.share.total == 700
        assert line.passed, line
