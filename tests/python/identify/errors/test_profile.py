"""Intervals of the profile likelihood."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import scipy
import stribeck as sb
from numpy.typing import NDArray
from stribeck.identify.errors.profile import Profile
from stribeck.identify.triangle import Triangle
from synthetic import Array, joint, motion, record

Q = 1.96


@dataclass
class Decay:
    """y = c exp(-x / b) + noise, with numpy alone; c is linear, b is not."""

    x: Array
    y: Array
    model: sb.Model
    torque_norm: float = 1.0

    @classmethod
    def made(cls, b: float) -> Decay:
        x = np.linspace(0.0, 1.0, 40)
        noise = 0.05 * np.random.default_rng(3).standard_normal(x.size)
        # Of this model only the names and roles of the parameters are read.
        model = sb.law("c*exp(-v/b)", c=1.0, b=b)
        return cls(x, 2.0 * np.exp(-x / b) + noise, model)

    def predict(self, values: Array) -> Array:
        c, b = values
        return c * np.exp(-self.x / b)

    def square(self, values: Array) -> float:
        return float(np.sum((self.y - self.predict(values)) ** 2))

    def profile(self, b: float) -> float:
        """The sum of squares minimised over c."""
        shape = np.exp(-self.x / b)
        return self.square(np.array([shape @ self.y / (shape @ shape), b]))

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        c, b = values
        with np.errstate(all="ignore"):
            shape = np.exp(-self.x / b)
            columns = np.column_stack([shape, c * shape * self.x / b**2])[:, wanted] * slope
            residual = self.y - c * shape
        if not (np.isfinite(columns).all() and np.isfinite(residual).all()):
            return None
        return Triangle.of(columns, residual)


def profile_of(problem: Decay, lower: Array, upper: Array) -> Profile:
    """The profile of b, with the variance of independent errors."""
    least = scipy.optimize.minimize_scalar(
        problem.profile, bounds=(0.01, 20.0), method="bounded", options={"xatol": 1e-12}
    )
    shape = np.exp(-problem.x / least.x)
    values = np.array([shape @ problem.y / (shape @ shape), least.x])
    variance = least.fun / (problem.x.size - 2)
    return Profile(problem, values, lower, upper, least.fun, 1, variance, Q)


def test_the_ends_are_where_the_sum_of_squares_reaches_the_threshold() -> None:
    problem = Decay.made(0.6)
    assert problem.model.names == ("c", "b")
    profile = profile_of(problem, np.array([-np.inf, 1e-3]), np.array([np.inf, 1e3]))
    found = profile.interval(0.05)
    assert found.open == ()
    for end in (found.low, found.high):
        rise = problem.profile(end) - profile.square
        assert rise == pytest.approx(Q**2 * profile.variance, rel=0.01)
    # The upper side is longer: the curve flattens as b grows.
    best = profile.values[1]
    assert found.low < best < found.high
    assert found.high - best > 1.05 * (best - found.low)
    # A first step that is far too long or far too short leads to the same ends.
    for step in (1e-6, 1e6):
        other = profile_of(problem, profile.lower, profile.upper).interval(step)
        assert (other.low, other.high) == pytest.approx((found.low, found.high), rel=2e-3)


def test_an_end_that_is_not_reached_is_open() -> None:
    """With an almost constant y, any slow decay will do."""
    problem = Decay.made(30.0)
    at_bound = profile_of(problem, np.array([-np.inf, 1e-3]), np.array([np.inf, 50.0]))
    found = at_bound.interval(1.0)
    assert found.open == ("upper",) and found.high == 50.0 and found.low > 1.0
    free = profile_of(problem, np.array([-np.inf, 1e-3]), np.full(2, np.inf))
    assert free.interval(1.0).high == np.inf
    assert free.interval(1.0).low == pytest.approx(found.low, rel=2e-3)


def test_of_a_linear_model_they_are_the_robust_intervals(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(noise=0.15, rho=0.9))
    robust, profile = (sb.fit("coulomb", recording, errors=e) for e in ("robust", "profile"))
    for name, e in robust.estimates.items():
        assert e.ci95 is not None and e.stderr is not None
        other = profile.estimates[name]
        assert other.ci95 == pytest.approx(e.ci95, abs=0.01 * e.stderr)
        assert other.stderr == e.stderr and other.open == ()
    assert profile.errors == "profile"


def test_weights_are_those_of_the_fit(tmp_path: Path) -> None:
    """A linear model has robust intervals also with weights."""
    rng = np.random.default_rng(8)
    sigma = np.where(np.arange(3000) // 50 % 2, 0.6, 0.03)
    frame = joint(sigma * rng.standard_normal(3000), noise=0.0).with_columns(sigma=pl.Series(sigma))
    recording = record(tmp_path, frame, weights="1/sigma^2")
    robust, profile = (sb.fit("coulomb", recording, errors=e) for e in ("robust", "profile"))
    plain = sb.fit("coulomb", record(tmp_path, frame, "plain"))
    for name, e in robust.estimates.items():
        assert e.ci95 is not None and e.stderr is not None
        assert profile.estimates[name].ci95 == pytest.approx(e.ci95, abs=0.01 * e.stderr)
        assert e.stderr < 0.3 * (plain.estimates[name].stderr or 0.0)
    bootstrap = sb.fit("coulomb", recording, errors="bootstrap", resamples=500)
    for name, e in robust.estimates.items():
        assert bootstrap.estimates[name].stderr == pytest.approx(e.stderr, rel=0.3)


def stribeck_curve(height: float) -> Array:
    v = motion()[2]
    return height * np.sign(v) * np.exp(-np.abs(v) / 0.1)


def test_of_a_stribeck_curve_they_are_asymmetric(tmp_path: Path) -> None:
    frame = joint(stribeck_curve(0.5), noise=0.3, rho=0.8)
    fit = sb.fit("coulomb+stribeck", record(tmp_path, frame), errors="profile")
    truth = {"stribeck_height": 0.5, "stribeck_velocity": 0.1, "stribeck_exponent": 1.0}
    for name, value in truth.items():
        e = fit.estimates[name]
        assert e.ci95 is not None and e.ci95[0] < value < e.ci95[1], name
    low, high = fit.estimates["stribeck_exponent"].ci95 or (0.0, 0.0)
    best = fit.estimates["stribeck_exponent"].value
    assert low > 0.0 and high - best > 1.5 * (best - low)


def test_what_the_data_does_not_bound_is_said(tmp_path: Path) -> None:
    """No Stribeck curve: its height may be zero, and then any velocity and exponent will do."""
    fit = sb.fit("coulomb+stribeck", record(tmp_path, joint()), errors="profile")
    height = fit.estimates["stribeck_height"]
    assert height.open == ("lower",) and height.ci95 is not None and height.ci95[0] == 0.0
    exponent = fit.estimates["stribeck_exponent"]
    assert exponent.at_bound and exponent.stderr is None
    assert exponent.open == ("lower", "upper")
    assert exponent.ci95 == (exponent.lower, exponent.upper)
    text = repr(fit)
    assert "Not bounded above by these data: stribeck_velocity and stribeck_exponent." in text
    assert "Not distinguished from zero by these data: stribeck_height." in text


def test_a_parameter_at_a_bound_has_a_limit_on_the_other_side(tmp_path: Path) -> None:
    v = motion()[2]
    frame = joint(-(1.2 + 0.02) * v, noise=0.3)
    e = sb.fit("coulomb", record(tmp_path, frame), errors="profile").estimates["viscous_friction"]
    assert e.at_bound and e.value == 0.0 and e.stderr is None
    assert e.open == ("lower",) and e.ci95 is not None
    assert e.ci95[0] == 0.0 < e.ci95[1] < 0.1


def test_an_infinite_end_is_null_in_json(tmp_path: Path) -> None:
    """A step may be steeper than measured: few samples lie within it."""
    v = motion()[2]
    frame = joint(3.0 * (np.tanh(1000.0 * v) - np.sign(v)), noise=1.0, velocity_noise=0.0)
    fit = sb.fit(
        "c1*v + c2*tanh(c3*v)",
        record(tmp_path, frame),
        start={"c3": 1000.0},
        starts=1,
        errors="profile",
    )
    e = fit.estimates["c3"]
    # The lower end is that of the minimum found, not of its mirror image with negative c2 and c3.
    assert e.ci95 is not None and e.ci95[1] == np.inf and 100.0 < e.ci95[0] < 1000.0
    said = e.to_dict()
    assert said["ci95"] == [e.ci95[0], None] and said["ci95_open"] == ["upper"]
    assert " to ∞" in repr(fit)


def test_a_smaller_error_within_an_interval_is_said(tmp_path: Path) -> None:
    """The sum of squares over the wave number of a wave that is not there has many minima."""
    frame = joint(noise=0.3)
    law = "c1*v + c2*sign(v) + c3*sin(k*q)"
    options = {"start": {"k": 3.0}, "bounds": {"k": (0.5, 40.0)}, "errors": "profile"}
    fit = sb.fit(law, record(tmp_path, frame), starts=1, **options)
    assert any("try more starts" in note for note in fit.notes)


def test_refits_need_bounds_alone(tmp_path: Path) -> None:
    recording = record(tmp_path, joint())
    for errors in ("profile", "bootstrap"):
        with pytest.raises(sb.SpecError, match="passive"):
            sb.fit("coulomb", recording, errors=errors, passive=True)
    with pytest.raises(sb.SpecError, match="robust or independent"):
        sb.fit("coulomb", recording, errors="nonsense")


def command(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    full = [sys.executable, "-m", "stribeck", "fit", "made.parquet", "--joint-kind", "revolute"]
    return subprocess.run([*full, *words], cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_the_command_prints_the_intervals(tmp_path: Path) -> None:
    joint(stribeck_curve(0.5), noise=0.3, rho=0.8).write_parquet(tmp_path / "made.parquet")
    options = ("--model", "coulomb+stribeck", "--starts", "3", "--errors", "profile")
    text = command(tmp_path, *options).stdout
    assert "95 % interval" in text and "profile likelihood" in text
    said = json.loads(command(tmp_path, *options, "--json").stdout)
    assert said["errors"] == "profile"
    for row in said["parameters"].values():
        assert row["ci95"][0] < row["value"] < row["ci95"][1] and row["ci95_open"] == []


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (("--errors", "profile", "--passive"), "--passive"),
        (("--errors", "profile", "--method", "grid"), "--method rms"),
        (("--errors", "profile", "--stream"), "--errors"),
        (("--resamples", "100"), "--errors bootstrap"),
        (("--errors", "bootstrap", "--resamples", "3"), "40"),
    ],
)
def test_the_command_refuses_what_does_not_go_together(
    tmp_path: Path, words: tuple[str, ...], hint: str
) -> None:
    joint().write_parquet(tmp_path / "made.parquet")
    done = command(tmp_path, "--model", "coulomb", *words)
    assert done.returncode == 2 and done.stdout == ""
    assert hint in done.stderr and "Traceback" not in done.stderr
    lines = done.stderr.strip().splitlines()
    assert len([line for line in lines if not line.startswith("note: ")]) == 1
