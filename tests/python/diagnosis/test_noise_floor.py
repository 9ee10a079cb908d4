"""The noise floor is the noise, whatever the model at hand leaves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.explainable import explainable
from stribeck.diagnosis.residual.noise_floor import noise_floor
from stribeck.diagnosis.residual.unexplained import unexplained
from stribeck.effect.columns import displacement_since_reversal, hats
from synthetic import ar1, joint, record


def repeats(noise: float, rho: float, extra: float = 0.0, seed: int = 2) -> pl.DataFrame:
    """The same motion again and again, so that states repeat exactly."""
    period, passes, rate = 400, 25, 100.0
    t = np.arange(period * passes) / rate
    w = 2 * np.pi * rate / period
    v = 0.8 * w * np.cos(w * t) + 0.3 * 2 * w * np.cos(2 * w * t + 0.5)
    q = 0.8 * np.sin(w * t) + 0.3 * np.sin(2 * w * t + 0.5)
    a = -0.8 * w**2 * np.sin(w * t) - 0.3 * 4 * w**2 * np.sin(2 * w * t + 0.5)
    rng = np.random.default_rng(seed)
    friction = 3.0 * np.sign(v) + 1.2 * v + extra * np.sign(v) * np.exp(-np.abs(v) / 0.2)
    load = 4.0 * np.sin(q) + 0.3 * a
    return pl.DataFrame(
        {
            "time": t,
            "position": q + 1e-6 * rng.standard_normal(t.size),
            "velocity": v + 1e-4 * rng.standard_normal(t.size),
            "acceleration": a,
            "torque": load + friction + ar1(rng, t.size, rho, noise),
            "load_torque": load,
        }
    )


@pytest.mark.parametrize("rho", [0.0, 0.8])
@pytest.mark.parametrize("noise", [0.02, 0.2])
def test_floor_is_the_noise(tmp_path: Path, noise: float, rho: float) -> None:
    fit = sb.fit("coulomb", record(tmp_path, repeats(noise, rho)))
    floor = noise_floor(fit)
    assert floor.value == pytest.approx(noise, rel=0.05) and floor.why is None


def test_floor_does_not_rise_with_what_is_missing(tmp_path: Path) -> None:
    """A missing Stribeck curve is a function of the speed and so no noise."""
    fit = sb.fit("coulomb", record(tmp_path, repeats(0.1, 0.0, extra=1.5)))
    floor = noise_floor(fit)
    assert fit.rmse > 2.0 * 0.1
    assert floor.value == pytest.approx(0.1, rel=0.05)
    left = unexplained(fit, floor, explainable(fit))
    assert left.is_structure and left.share == pytest.approx(1 - 0.01 / fit.rmse**2, abs=0.05)
    assert left.where is not None
    assert "low speed" in left.where or "reversal" in left.where


def test_floor_is_never_above_the_error(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", plain)
    floor = noise_floor(fit)
    assert floor.value is not None and floor.value <= fit.rmse
    left = unexplained(fit, floor, explainable(fit))
    assert not left.is_structure and left.where is None


def test_too_little_data_says_so(tmp_path: Path) -> None:
    few = record(tmp_path, joint(rows=250))
    floor = noise_floor(sb.fit("coulomb", few))
    assert floor.value is None and floor.why is not None and "samples" in floor.why


def test_displacement_starts_at_each_reversal(plain: sb.Recording) -> None:
    travel = displacement_since_reversal(plain)
    v = plain.velocity
    assert np.all(travel >= 0)
    turned = np.flatnonzero(np.diff(np.sign(v)) != 0) + 1
    assert np.all(travel[turned[(turned > 5) & plain.moving[turned]]] < 0.05)
    last, before = turned[-1], turned[-2]
    moved = abs(plain.position[last - 1] - plain.position[before])
    assert travel[last - 1] == pytest.approx(moved, rel=0.02)


def test_hats_hold_every_piecewise_linear_curve() -> None:
    x = np.linspace(0.0, 2.0, 400)
    columns = np.column_stack([np.ones_like(x), *hats(x, 5)])
    curve = np.abs(x - 1.0)
    left = curve - columns @ np.linalg.lstsq(columns, curve, rcond=None)[0]
    assert np.abs(left).max() < 1e-12
    assert hats(np.zeros(50), 5) == []


def turning(slow: float) -> pl.DataFrame:
    """A joint that turns forward only, with a slow wave of torque along its way."""
    rng = np.random.default_rng(3)
    t = np.arange(6000) / 100.0
    v = 1.0 + 0.5 * np.sin(2 * np.pi * 0.2 * t)
    q = np.cumsum(v) / 100.0
    noise = 0.03 * rng.standard_normal(t.size)
    torque = 3.0 + 1.2 * v + slow * np.sin(1.7 * q) + noise
    zero = np.zeros(t.size)
    return pl.DataFrame(
        {"time": t, "position": q, "velocity": v, "torque": torque, "load_torque": zero}
    )


def test_where_no_position_is_passed_twice_a_wave_is_not_called_noise(tmp_path: Path) -> None:
    floor = noise_floor(sb.fit("coulomb", record(tmp_path, turning(0.5))))
    assert floor.value is None and "passes no position twice" in str(floor.why)
    assert not floor.is_reached_by(0.03)
    found = sb.improve("coulomb", record(tmp_path, turning(0.5), "again"))
    assert found.stopped == "nothing_passes" and found.unexplained.share is None


def test_white_noise_needs_no_repeats(tmp_path: Path) -> None:
    floor = noise_floor(sb.fit("coulomb", record(tmp_path, turning(0.0))))
    assert floor.value == pytest.approx(0.03, rel=0.1)
    assert floor.is_reached_by(0.031) and not floor.is_reached_by(0.06)
