"""Errors from refits to resampled blocks."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy
import stribeck as sb
from stribeck.identify.errors.bootstrap import CELLS, MOST_BLOCKS, Resamples, resampled
from stribeck.identify.problem import Problem
from synthetic import Array, joint, motion, record


def problem_of(fit: sb.Fit) -> Problem:
    return Problem(fit.recording, fit.model, fit.rows)


def bounds_of(fit: sb.Fit) -> tuple[Array, Array]:
    lower, upper = np.array([fit.model.bounds[name] for name in fit.model.names]).T
    return lower, upper


def drawn(samples: int, count: int, seed: int) -> list[Array]:
    """The samples of each of two resamples, by copying them block by block."""
    rng = np.random.default_rng(seed)
    cell = np.arange(samples) * count // samples
    made = []
    for _ in range(2):
        starts = rng.integers(count, size=count // CELLS)
        cells = [(start + k) % count for start in starts for k in range(CELLS)]
        made.append(np.concatenate([np.flatnonzero(cell == c) for c in cells]))
    return made


def test_a_refit_is_the_fit_to_the_samples_drawn(tmp_path: Path) -> None:
    """A weighting of triangular factors replaces copies of samples."""
    fit = sb.fit("coulomb", record(tmp_path, joint(noise=0.15, rho=0.5)))
    found = resampled(
        problem_of(fit), fit.model.values, *bounds_of(fit), length=1.0, resamples=2, seed=9
    )
    assert found.blocks == MOST_BLOCKS and found.unsettled == 0
    v = fit.recording.velocity[fit.rows]
    y = (fit.recording.torque - fit.recording.known_torque)[fit.rows]
    columns = np.column_stack([v, np.sign(v)])
    for refit, rows in zip(found.values, drawn(v.size, CELLS * MOST_BLOCKS, 9), strict=True):
        expected = np.linalg.lstsq(columns[rows], y[rows], rcond=None)[0]
        np.testing.assert_allclose(refit, expected, rtol=1e-9)


def test_a_refit_of_a_curve_is_the_fit_to_the_samples_drawn(tmp_path: Path) -> None:
    v = motion()[2]
    frame = joint(1.5 * np.sign(v) * np.exp(-np.abs(v) / 0.1), noise=0.1)
    fit = sb.fit("coulomb+stribeck", record(tmp_path, frame), fix={"stribeck_exponent": 1.0})
    found = resampled(
        problem_of(fit), fit.model.values, *bounds_of(fit), length=1.0, resamples=2, seed=4
    )
    speed = np.abs(fit.recording.velocity[fit.rows])
    sign = np.sign(fit.recording.velocity[fit.rows])
    y = (fit.recording.torque - fit.recording.known_torque)[fit.rows]
    for refit, rows in zip(found.values, drawn(y.size, CELLS * MOST_BLOCKS, 4), strict=True):

        def residual(p: Array, rows: Array = rows) -> Array:
            curve = p[1] + p[2] * np.exp(-speed[rows] / p[3])
            return y[rows] - sign[rows] * (p[0] * speed[rows] + curve)

        expected = scipy.optimize.least_squares(residual, fit.model.values[:4], xtol=1e-12).x
        np.testing.assert_allclose(refit[:4], expected, rtol=1e-4)


def test_the_interval_of_a_normal_estimate_is_that_of_student() -> None:
    """Resamples vary less than independent blocks would; the levels make up for it."""
    blocks, error = 12, 0.3
    narrow = error * np.sqrt((blocks - 1) / blocks)
    normal = scipy.stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000)
    found = Resamples(5.0 + narrow * normal[:, None], blocks, 0)
    reach = scipy.stats.t.ppf(0.975, blocks - 1) * error
    assert found.interval(0) == pytest.approx((5.0 - reach, 5.0 + reach), rel=1e-3)
    assert np.sqrt(found.covariance()[0, 0]) == pytest.approx(error, rel=1e-3)


def test_its_errors_are_those_of_correlated_noise(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(noise=0.15, rho=0.9))
    robust = sb.fit("coulomb", recording)
    fit = sb.fit("coulomb", recording, errors="bootstrap", resamples=2000)
    independent = sb.fit("coulomb", recording, errors="independent")
    assert fit.covariance is not None and fit.correlation is not None
    for k, (name, e) in enumerate(fit.estimates.items()):
        other, naive = robust.estimates[name].stderr, independent.estimates[name].stderr
        assert e.stderr is not None and other is not None and naive is not None
        assert e.stderr == pytest.approx(other, rel=0.25)
        assert e.stderr > 2.0 * naive
        assert e.stderr == np.sqrt(fit.covariance.values[k, k])
        assert e.ci95 is not None and e.ci95[0] < e.value < e.ci95[1]
    assert fit.errors == "bootstrap"
    assert "refits to resampled blocks" in repr(fit)


def test_the_same_seed_gives_the_same_errors(tmp_path: Path) -> None:
    v = motion()[2]
    recording = record(tmp_path, joint(np.sign(v) * np.exp(-np.abs(v) / 0.1), noise=0.1))

    def errors(seed: int) -> list[float | None]:
        options = {"errors": "bootstrap", "resamples": 40, "starts": 3, "seed": seed}
        fit = sb.fit("coulomb+stribeck", recording, **options)
        return [e.stderr for e in fit.estimates.values()]

    assert errors(1) == errors(1) != errors(2)


def test_a_parameter_at_a_bound_has_an_interval(tmp_path: Path) -> None:
    v = motion()[2]
    recording = record(tmp_path, joint(-1.21 * v, noise=0.3))
    fit = sb.fit("coulomb", recording, errors="bootstrap")
    e = fit.estimates["viscous_friction"]
    assert e.at_bound and e.stderr is None and e.open == ("lower",)
    assert e.ci95 is not None and e.ci95[0] == 0.0 < e.ci95[1] < 0.1


@pytest.mark.slow
def test_the_command_resamples(tmp_path: Path) -> None:
    joint(noise=0.15).write_parquet(tmp_path / "made.parquet")
    words = ["fit", "made.parquet", "--model", "coulomb", "--joint-kind", "revolute", "--json"]

    def run(*more: str) -> dict[str, dict[str, object]]:
        command = [sys.executable, "-m", "stribeck", *words, "--errors", "bootstrap", *more]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)["parameters"]

    default, few = run(), run("--resamples", "40")
    assert default == run("--resamples", "200")
    assert default["coulomb_friction"]["stderr"] != few["coulomb_friction"]["stderr"]
