"""Separable least squares: the last steps of every fit, and searches without bounds."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.separable import CAUTIOUS, minimise
from synthetic import joint_with_stribeck_curve, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    return record(tmp_path_factory.mktemp("separable"), joint_with_stribeck_curve())


def problem(recording: sb.Recording, spec: str) -> tuple[Problem, np.ndarray, np.ndarray]:
    """A model on all moving rows, and its bounds."""
    made = model_for(spec, recording)
    lower, upper, _ = bounds(made, recording)
    return Problem(recording, made, np.flatnonzero(recording.moving)), lower, upper


def test_never_goes_up_and_ends_at_a_minimum(recording: sb.Recording) -> None:
    p, lower, upper = problem(recording, "coulomb+stribeck")
    best = sb.fit("coulomb+stribeck", recording)
    rng = np.random.default_rng(1)
    for _ in range(5):
        start = np.clip(best.model.values * np.exp(0.2 * rng.standard_normal(5)), lower, upper)
        first, _ = p.linearise(start)
        found = minimise(p, start, lower, upper)
        assert found.converged and found.evaluations < 40
        assert found.square <= first @ first
        assert np.all(found.values >= lower) and np.all(found.values <= upper)
        assert np.sqrt(found.square / p.rows.size) == pytest.approx(best.rmse, rel=1e-9)


@pytest.mark.parametrize("logarithmic", [False, True])
def test_finds_the_same_without_bounds(recording: sb.Recording, logarithmic: bool) -> None:
    p, lower, upper = problem(recording, "coulomb+stribeck")
    best = sb.fit("coulomb+stribeck", recording)
    free = np.full(lower.size, np.inf)
    signs = np.full(lower.size, logarithmic)
    start = np.clip(best.model.values * 2.0, lower, upper)
    found = minimise(p, start, -free, free, damping=CAUTIOUS, logarithmic=signs, most=200)
    # The law knows |v/vs| alone; only the logarithm keeps the sign of vs.
    size = found.values if logarithmic else np.abs(found.values)
    np.testing.assert_allclose(size, best.model.values, rtol=1e-6)


def test_equal_bounds_hold_a_parameter(recording: sb.Recording) -> None:
    p, lower, upper = problem(recording, "coulomb+stribeck")
    names = p.model.names
    speed, viscous = names.index("stribeck_velocity"), names.index("viscous_friction")
    for held in (speed, viscous):
        low, high = lower.copy(), upper.copy()
        low[held] = high[held] = 0.2
        found = minimise(p, 0.5 * (low + high), low, high)
        assert found.converged and found.values[held] == 0.2
        residual, jacobian = p.linearise(found.values)
        slope = np.abs(jacobian.T @ residual)
        inside = (found.values > low) & (found.values < high)
        assert slope[inside].max() < 1e-6 * slope[held]
    everything = minimise(p, upper, upper, upper)
    np.testing.assert_array_equal(everything.values, upper)
    assert everything.converged and everything.evaluations == 1


def test_a_start_that_is_not_finite_is_said(recording: sb.Recording) -> None:
    p, lower, _ = problem(recording, "coulomb+stribeck")
    start = np.full(lower.size, 1e308)
    found = minimise(p, start, np.full(start.size, -np.inf), np.full(start.size, np.inf))
    assert not found.converged and found.square == np.inf
