"""Prediction of each block by a model fitted without it, against fits that leave the block out.

The reference is least squares by numpy on the samples of the other blocks, with columns made here.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import scipy
import stribeck as sb
from stribeck.identify import held_out
from stribeck.identify.held_out import ASTRAY, Bounded, held_out_prediction, held_out_residual
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from synthetic import joint_with_stribeck_curve, record

Array = np.ndarray
FREE = (np.array([-np.inf, -np.inf]), np.array([np.inf, np.inf]))


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve, so that a straight line leaves other errors in each block.

    It rests every three seconds for a moment.
    """
    resting = pl.col("time") % 3.0 < 0.3
    frame = joint_with_stribeck_curve().with_columns(
        pl.when(resting).then(0.0).otherwise(pl.col("velocity")).alias("velocity")
    )
    return record(tmp_path_factory.mktemp("blocks"), frame)


@pytest.fixture(scope="module")
def line(recording: sb.Recording) -> Problem:
    """Coulomb and viscous friction, linear in both parameters."""
    made = model_for("coulomb", recording)
    return Problem(recording, made, np.flatnonzero(recording.moving))


def columns(recording: sb.Recording) -> Array:
    v = recording.velocity
    return np.column_stack([v, np.sign(v)])


def solved(p: Problem, kept: Array, weight: Array | None = None) -> Array:
    """Least squares over the samples `kept`."""
    root = np.sqrt(np.ones(p.recording.rows) if weight is None else weight)[kept]
    target = (p.recording.torque - p.recording.known_torque)[kept]
    a = columns(p.recording)[kept]
    return np.linalg.lstsq(a * root[:, None], target * root, rcond=None)[0]


def others(p: Problem, b: int) -> Array:
    """Fitted samples outside block `b`."""
    return p.rows[p.recording.block[p.rows] != b]


@pytest.mark.parametrize("weighted", [False, True])
def test_linear_refits_are_least_squares_without_the_block(line: Problem, weighted: bool) -> None:
    r = line.recording
    weight = 0.2 + np.random.default_rng(0).random(r.rows) if weighted else None
    p = replace(line, loss_weight=weight)
    best = solved(p, p.rows, weight)
    prediction, refits = held_out_prediction(p, best, *FREE)
    assert refits.shape == (r.block_count, 2) and r.block_count > 2
    for b in range(r.block_count):
        expected = solved(p, others(p, b), weight)
        np.testing.assert_allclose(refits[b], expected, rtol=1e-9)
        moving = np.flatnonzero((r.block == b) & r.moving)
        made = columns(r)[moving] @ expected + r.known_torque[moving]
        np.testing.assert_allclose(prediction[moving], made, rtol=1e-9, atol=1e-9)
        # Samples at rest are predicted without their block too.
        every = np.flatnonzero(r.block == b)
        np.testing.assert_allclose(prediction[every], p.predict(expected)[every], atol=1e-9)
    left = held_out_residual(p, best, *FREE)
    np.testing.assert_allclose(left, (r.torque - prediction)[p.rows], atol=1e-9)


def test_a_linearisation_serves_moving_samples_alone(line: Problem) -> None:
    r = line.recording
    best = solved(line, line.rows)
    exact, refits = held_out_prediction(line, best, *FREE)
    quick, same = held_out_prediction(line, best, *FREE, exact=False)
    np.testing.assert_allclose(same, refits, rtol=1e-9)
    np.testing.assert_allclose(quick[r.moving], exact[r.moving], atol=1e-9)
    np.testing.assert_array_equal(quick[~r.moving], line.predict(best)[~r.moving])


def test_refits_stay_within_bounds_and_held_parameters_stay(line: Problem) -> None:
    best = solved(line, line.rows)
    limit = best + np.array([0.0, 1.0])
    _, refits = held_out_prediction(line, best, best - 1.0, limit)
    viscous = np.array([solved(line, others(line, b))[0] for b in range(len(refits))])
    above = viscous > best[0]
    assert above.any() and not above.all()
    np.testing.assert_array_equal(refits[above, 0], best[0])
    np.testing.assert_allclose(refits[~above, 0], viscous[~above], rtol=1e-9)
    held = (best - np.array([0.0, 10.0]), best + np.array([0.0, 10.0]))
    left = held_out_residual(line, best, *held)
    prediction, refits = held_out_prediction(line, best, *held)
    np.testing.assert_array_equal(refits[:, 0], best[0])
    np.testing.assert_allclose(left, (line.recording.torque - prediction)[line.rows], atol=1e-9)
    slope, sign = columns(line.recording).T
    dry = line.recording.torque - line.recording.known_torque - best[0] * slope
    for b, (_, friction) in enumerate(refits):
        kept = others(line, b)
        assert friction == pytest.approx(np.mean(dry[kept] * sign[kept]), rel=1e-9)


def test_a_block_without_fitted_samples_changes_nothing(line: Problem) -> None:
    r = line.recording
    fewer = replace(line, rows=line.rows[r.block[line.rows] != 1])
    best = solved(fewer, fewer.rows)
    prediction, refits = held_out_prediction(fewer, best, *FREE)
    at = r.block == 1
    np.testing.assert_array_equal(refits[1], best)
    np.testing.assert_array_equal(prediction[at], fewer.predict(best)[at])
    assert not np.allclose(refits[2], best, rtol=1e-9)


def test_two_blocks_are_enough_and_one_is_not(line: Problem) -> None:
    r = line.recording
    half = (np.arange(r.rows) * 2 // r.rows).astype(r.block.dtype)
    best = solved(line, line.rows)
    two = replace(line, recording=replace(r, block=half, block_count=2))
    _, refits = held_out_prediction(two, best, *FREE)
    for b in range(2):
        np.testing.assert_allclose(refits[b], solved(two, others(two, b)), rtol=1e-9)
    one = replace(line, recording=replace(r, block=0 * half, block_count=1))
    prediction, refits = held_out_prediction(one, best, *FREE)
    assert np.isnan(prediction).all() and prediction.size == r.rows
    np.testing.assert_array_equal(refits, best[None, :])


@pytest.fixture(scope="module")
def curve(recording: sb.Recording) -> tuple[Problem, Array, Array, Array]:
    """A Stribeck curve, not linear in its velocity: the problem, its best values, their bounds."""
    made = model_for("coulomb+stribeck", recording)
    lower, upper, _ = bounds(made, recording)
    p = Problem(recording, made, np.flatnonzero(recording.moving))
    start = sb.fit("coulomb+stribeck", recording).model.values
    return p, searched(p, p.rows, start, lower, upper), lower, upper


def searched(p: Problem, kept: Array, start: Array, lower: Array, upper: Array) -> Array:
    """The least squares of SciPy over the samples `kept`."""
    part = replace(p, rows=kept)
    scale = np.abs(start)
    found = scipy.optimize.least_squares(
        lambda x: part.residual(x * scale), start / scale, jac="3-point",
        bounds=(lower / scale, upper / scale), xtol=1e-13, ftol=1e-15, gtol=1e-13,
    )  # fmt: skip
    return found.x * scale


def test_refits_of_a_curve_are_those_of_a_search(
    curve: tuple[Problem, Array, Array, Array],
) -> None:
    p, best, lower, upper = curve
    prediction, refits = held_out_prediction(p, best, lower, upper)
    r = p.recording
    for b in range(0, r.block_count, 3):
        kept = others(p, b)
        expected = searched(p, kept, best, lower, upper)
        # Two steps converge quadratically: what is left is small beside the change.
        change = np.abs(expected - best).max()
        np.testing.assert_allclose(refits[b], expected, rtol=0, atol=0.01 * change)
        at = np.flatnonzero(r.block == b)
        np.testing.assert_array_equal(prediction[at], p.predict(refits[b])[at])


def test_a_step_that_goes_astray_is_replaced_by_a_search(
    curve: tuple[Problem, Array, Array, Array],
) -> None:
    """From far values one step may raise the error; the refit still ends at the minimum."""
    p, best, lower, upper = curve
    by = Bounded(lower, upper)
    square = float(np.sum(p.residual(best) ** 2))
    names = [parameter.name for parameter in p.model.parameters]
    velocity = names.index("stribeck_velocity")
    far = best.copy()
    far[velocity] = min(30.0 * best[velocity], upper[velocity])
    found = by.refine(p, far, best, square)
    assert np.sum(p.residual(found) ** 2) <= square * (1.0 + 1e-6)


@pytest.mark.parametrize("factor", [0.1, 0.3, 3.0, 10.0, 100.0])
def test_no_refit_leaves_much_more_than_before(
    curve: tuple[Problem, Array, Array, Array], factor: float
) -> None:
    """Wherever it starts, a step that more than doubles the sum of squares is not taken."""
    p, best, lower, upper = curve
    start = np.clip(best * factor, lower, upper)
    square = float(np.sum(p.residual(start) ** 2))
    found = Bounded(lower, upper).refine(p, start, start, square)
    assert np.sum(p.residual(found) ** 2) <= ASTRAY * square
    assert np.all(found >= lower) and np.all(found <= upper)


@pytest.mark.parametrize(("velocity", "exponent"), [(0.5, 0.25), (2.0, 0.25), (8.0, 0.25)])
def test_a_step_that_raises_the_error_is_not_taken(
    curve: tuple[Problem, Array, Array, Array], velocity: float, exponent: float
) -> None:
    """A sharper and a wider curve, from which a Gauss-Newton step more than doubles the error."""
    p, best, lower, upper = curve
    factor = {"stribeck_velocity": velocity, "stribeck_exponent": exponent}
    factors = [factor.get(name, 1.0) for name in p.model.names]
    start = np.clip(best * factors, lower, upper)
    every = np.arange(start.size)
    here = p.triangle(start, every, np.ones(start.size))
    assert here is not None
    square = here.square
    by = Bounded(lower, upper)
    step = by.step(start, here)
    assert np.sum(p.residual(step) ** 2) > ASTRAY * square
    found = by.refine(p, start, start, square)
    assert np.sum(p.residual(found) ** 2) <= square * (1.0 + 1e-12)


def along_the_stroke(folder: Path, farther: float) -> sb.Recording:
    """Friction that varies along a stroke, whose ends one tenth of the recording alone passes."""
    t = np.arange(6000) / 200.0
    amplitude = np.where((t > 12.0) & (t < 15.0), farther, 1.0)
    w = 2.0 * np.pi / 1.5
    q, v = amplitude * np.sin(w * t), amplitude * w * np.cos(w * t)
    friction = np.sign(v) * (2.0 + 0.3 * np.cos(q)) + 0.1 * v
    noise = 0.2 * np.random.default_rng(4).standard_normal(t.size)
    frame = pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v,
            "acceleration": -(w**2) * q,
            "torque": friction + noise,
            "load_torque": 0.0 * t,
        }
    )
    made = record(folder, frame)
    # The tenths of the time: stretches of so fast a motion would be held out in turn.
    return replace(made, block=np.arange(made.rows) * 10 // made.rows)


def test_a_series_is_not_extrapolated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The refit without the block that alone reaches the ends has no say there."""
    recording = along_the_stroke(tmp_path, 2.5)
    plain = sb.fit("coulomb", recording).rmse_held_out
    found = sb.fit("coulomb+position", recording).rmse_held_out
    assert found is not None and plain is not None and found < 0.97 * plain
    monkeypatch.setattr(held_out, "DETERMINED", 0.0)
    extrapolated = sb.fit("coulomb+position", recording).rmse_held_out
    assert extrapolated is not None and extrapolated > plain


def test_a_series_that_every_block_determines_is_refitted_as_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recording = along_the_stroke(tmp_path, 1.0)
    found = sb.fit("coulomb+position", recording).rmse_held_out
    monkeypatch.setattr(held_out, "DETERMINED", 0.0)
    assert found == pytest.approx(sb.fit("coulomb+position", recording).rmse_held_out, rel=1e-4)
