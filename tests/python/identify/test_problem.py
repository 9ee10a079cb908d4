"""One model on one recording: target, rows, the slope that the search follows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.space import SearchSpace
from synthetic import joint, joint_with_stribeck_curve, motion, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    return record(tmp_path_factory.mktemp("problem"), joint_with_stribeck_curve())


def problem(recording: sb.Recording, spec: str) -> tuple[Problem, np.ndarray, np.ndarray]:
    """A model on all moving rows, and its bounds."""
    made = model_for(spec, recording)
    lower, upper, _ = bounds(made, recording)
    return Problem(recording, made, np.flatnonzero(recording.moving)), lower, upper


def test_target_is_the_torque_as_recorded(recording: sb.Recording) -> None:
    p, _, _ = problem(recording, "coulomb+delay")
    assert p.target.tobytes() == recording.torque[recording.moving].tobytes()
    values = np.array([1.0, 2.0, 0.004])
    residual, _ = p.linearise(values)
    expected = recording.torque - p.predict(values)
    np.testing.assert_allclose(residual, expected[recording.moving], rtol=0, atol=1e-12)


def test_search_coordinates_span_the_bounds(recording: sb.Recording) -> None:
    p, lower, upper = problem(recording, "coulomb+stribeck+presliding+delay")
    space = SearchSpace.of(p, lower, upper)
    low, high = lower[space.nonlinear], upper[space.nonlinear]
    np.testing.assert_allclose(space.decode(np.zeros(low.size)), low, rtol=1e-12)
    np.testing.assert_allclose(space.decode(np.ones(low.size)), high, rtol=1e-12)
    u = np.random.default_rng(0).uniform(size=low.size)
    values = np.zeros(lower.size)
    values[space.nonlinear] = space.decode(u)
    np.testing.assert_allclose(space.encode(values), u, atol=1e-12)
    # Halfway in the logarithm where that has a meaning.
    with np.errstate(invalid="ignore"):
        half = np.where(low > 0.0, np.sqrt(low * high), 0.5 * (low + high))
    np.testing.assert_allclose(space.decode(np.full(low.size, 0.5)), half, rtol=1e-12)


def test_fewer_rows_are_spread_and_windows_are_where_it_turns(recording: sb.Recording) -> None:
    p, _, _ = problem(recording, "coulomb+presliding")
    thin = p.thinned(500)
    assert thin.rows.size <= 500 and np.ptp(thin.rows) > 0.95 * recording.rows
    assert p.thinned(10**6) is p
    part = p.window(1000)
    assert part.span is not None and part.span[1] - part.span[0] == 1000
    assert part.rows.min() >= part.span[0] and part.rows.max() < part.span[1]


@pytest.mark.parametrize("slides", [False, True])
def test_first_rows_tell_how_a_run_in_motion_began(slides: bool, tmp_path: Path) -> None:
    """A bristle without viscous friction, from its path alone; two runs alike."""
    stiffness, coulomb, rows = 40.0, 3.0, 1500
    q, v = motion(rows)[1:3]
    z = np.sign(v[0]) * coulomb / stiffness if slides else 0.0
    bristle = [stiffness * z]
    for path in np.diff(q):
        steady = np.sign(path) * coulomb / stiffness
        z = steady + (z - steady) * np.exp(-np.abs(path) * stiffness / coulomb)
        bristle.append(stiffness * z)
    frame = joint(rows=rows, noise=0.0, velocity_noise=0.0).with_columns(
        torque=pl.col("load_torque") + np.array(bristle)
    )
    both = pl.concat(
        [
            frame.with_columns(run=pl.lit("a")),
            frame.with_columns(pl.col("time") + 100.0, run=pl.lit("b")),
        ]
    )
    p, _, _ = problem(record(tmp_path, both, map={"run": "run"}), "coulomb+presliding")
    residual, _ = p.linearise(np.array([0.0, coulomb, stiffness, 0.0]))
    assert np.abs(residual).max() < 1e-9
