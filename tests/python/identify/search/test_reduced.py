"""The reduced sum of squares and its gradient."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.reduced import _reduced, reduced, squares
from synthetic import joint, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    return record(tmp_path_factory.mktemp("reduced"), joint())


@pytest.mark.parametrize("law", ["bittencourt_a", "makkar", "hao_b", "lugre"])
def test_the_slope_is_the_derivative(recording: sb.Recording, law: str) -> None:
    model = model_for(law, recording)
    lower, upper, start = bounds(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving))
    found = reduced(problem, start[None, :], lower, upper)[0]
    assert found is not None
    for k, p in enumerate(model.parameters):
        if p.linear:
            assert found.slope[k] == 0.0
            continue
        step = 1e-5 * max(abs(start[k]), 1e-3)
        points = np.stack([start, start])
        points[:, k] += [-step, step]
        below, above = squares(problem, points, lower, upper)
        expected = (above - below) / (2.0 * step)
        assert found.slope[k] == pytest.approx(expected, rel=2e-3, abs=1e-6 * found.square)


def test_the_linear_parameters_are_the_best(recording: sb.Recording) -> None:
    model = model_for("bittencourt_a", recording)
    lower, upper, start = bounds(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving))
    found = reduced(problem, start[None, :], lower, upper)[0]
    assert found is not None
    assert found.square == pytest.approx(np.sum(problem.residual(found.values) ** 2), rel=1e-10)
    for k in (k for k, p in enumerate(model.parameters) if p.linear):
        for step in (-1e-3, 1e-3):
            other = found.values.copy()
            other[k] += step
            assert np.sum(problem.residual(other) ** 2) >= found.square


def test_python_and_the_core_agree(recording: sb.Recording) -> None:
    model = model_for("dong", recording)
    lower, upper, start = bounds(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving))
    core = reduced(problem, start[None, :], lower, upper)[0]
    own = _reduced(problem, start, lower, upper)
    assert core is not None and own is not None
    assert own.square == pytest.approx(core.square, rel=1e-12)
    np.testing.assert_allclose(own.values, core.values, rtol=1e-9)
    np.testing.assert_allclose(own.slope, core.slope, rtol=1e-6, atol=1e-9 * core.square)
