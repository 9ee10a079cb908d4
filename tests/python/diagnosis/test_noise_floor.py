"""The noise floor is the noise, whatever the model at hand leaves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from made_fits import Array, Moved, left
from stribeck.diagnosis.residual.explainable import explainable
from stribeck.diagnosis.residual.noise_floor import (
    FEWEST_PAIRS,
    ONCE,
    REACHED,
    NoiseFloor,
    noise_floor,
    state_features,
)
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


def turning(slow: float, waves: float = 1.7, speed: float = 1.0) -> pl.DataFrame:
    """A joint that turns forward only, with a wave of torque along its way."""
    rng = np.random.default_rng(3)
    t = np.arange(6000) / 100.0
    v = speed * (1.0 + 0.5 * np.sin(2 * np.pi * 0.2 * t))
    q = np.cumsum(v) / 100.0
    noise = 0.03 * rng.standard_normal(t.size)
    torque = 3.0 + 1.2 * v + slow * np.sin(waves * q) + noise
    zero = np.zeros(t.size)
    return pl.DataFrame(
        {"time": t, "position": q, "velocity": v, "torque": torque, "load_torque": zero}
    )


def test_where_no_position_is_passed_twice_a_wave_is_not_called_noise(tmp_path: Path) -> None:
    part_of_a_turn = turning(0.5, waves=8.0, speed=0.2)
    floor = noise_floor(sb.fit("coulomb", record(tmp_path, part_of_a_turn)))
    assert floor.value is None and "passes no position twice" in str(floor.why)
    assert not floor.is_reached_by(0.03)
    found = sb.improve("coulomb", record(tmp_path, turning(0.5), "again"))
    assert found.stopped == "nothing_passes"
    assert found.unexplained.where is not None and "lasts longer" in found.unexplained.where


def test_a_wave_that_repeats_with_each_turn_is_not_called_noise(tmp_path: Path) -> None:
    """The joint turns forward only, so no position is passed twice, but the angle is."""
    fitted = sb.fit("coulomb", record(tmp_path, turning(0.1, 3.0, speed=15.0)))
    assert fitted.rmse == pytest.approx(np.hypot(0.03, 0.1 / np.sqrt(2.0)), rel=0.05)
    assert not noise_floor(fitted).is_reached_by(fitted.rmse)
    found = sb.improve("coulomb", fitted.recording)
    assert found.unexplained.is_structure


def test_white_noise_needs_no_repeats(tmp_path: Path) -> None:
    floor = noise_floor(sb.fit("coulomb", record(tmp_path, turning(0.0))))
    assert floor.value == pytest.approx(0.03, rel=0.1)
    assert floor.is_reached_by(0.031) and not floor.is_reached_by(0.06)


def twice(gap: Array, gamma: Array, rmse: float = np.inf, seed: int = 4) -> sb.Fit:
    """States that are passed twice, a distance apart; half of the squared difference is `gamma`.

    All are far from each other, and far apart in time. The residual changes its sign at random.
    """
    rng = np.random.default_rng(seed)
    speed = 10.0 + 100.0 * rng.permutation(gap.size)
    half = rng.choice([-1.0, 1.0], gap.size) * np.sqrt(gamma / 2.0)
    return left(
        Moved(np.concatenate([speed, speed + gap])), np.concatenate([half, -half]), rmse=rmse
    )


STATES = 2 * FEWEST_PAIRS


def test_floor_is_half_of_the_squared_difference_of_repetitions() -> None:
    gamma = np.random.default_rng(1).uniform(1.0, 3.0, STATES)
    same = np.zeros(STATES)
    assert noise_floor(twice(same, gamma)).value == pytest.approx(np.sqrt(gamma.mean()))
    # It is never above the error itself.
    assert noise_floor(twice(same, gamma, rmse=0.5)).value == 0.5


@pytest.mark.parametrize("slope", [0.0, 5.0, -1.0])
def test_floor_is_that_at_no_distance(slope: float) -> None:
    """A rise with the squared distance is the torque's, not the noise's; a fall is chance."""
    squared = np.linspace(0.0, 1.0, STATES)
    gamma = 2.0 + slope * squared
    near = squared <= np.median(squared)
    expected = 2.0 if slope > 0.0 else gamma[near].mean()
    found = noise_floor(twice(np.sqrt(squared), gamma)).value
    assert found == pytest.approx(np.sqrt(expected), rel=1e-6)


def test_a_line_below_zero_is_no_variance() -> None:
    """Half of the pairs count; where their line would start below zero, their mean is taken."""
    squared = np.linspace(0.2, 1.0, STATES)
    gamma = 10.0 * (squared - 0.2) ** 2
    near = squared <= np.median(squared)
    found = noise_floor(twice(np.sqrt(squared), gamma)).value
    assert found == pytest.approx(np.sqrt(gamma[near].mean()), rel=1e-6)


def test_states_that_are_passed_once_have_no_repetitions() -> None:
    residual = np.random.default_rng(1).standard_normal(STATES)
    said = noise_floor(left(Moved(1.0 + np.arange(float(STATES))), residual))
    assert said.value is None and "same state twice" in str(said.why)
    few = slice(0, FEWEST_PAIRS - 1)
    said = noise_floor(left(Moved(np.ones(FEWEST_PAIRS - 1)), residual[few]))
    assert said.value is None and f"({FEWEST_PAIRS - 1})" in str(said.why)


def test_samples_close_in_time_are_no_repetition() -> None:
    """Noise that lasts as long as a state is held; only the second pass has another one."""
    held, states = 30, 40
    rng = np.random.default_rng(2)
    speed = np.repeat(10.0 + 100.0 * rng.permutation(states), held)
    noise = np.repeat(rng.choice([-1.0, 1.0], states), held)
    fit = left(Moved(np.concatenate([speed, speed])), np.concatenate([noise, -noise]))
    assert noise_floor(fit).value == pytest.approx(np.sqrt(2.0))


@pytest.mark.parametrize(("back", "once"), [(0.0, True), (0.4, True), (0.6, False)])
def test_a_position_is_passed_twice_after_half_of_the_way_back(back: float, once: bool) -> None:
    assert ONCE == 1.5
    size = 4000
    speed = np.where(np.arange(size) < size / (1.0 + back), 1.0, -1.0)
    dt = np.full(size, 0.01)
    smooth = np.sin(2.0 * np.pi * np.arange(size) / 1000.0)
    moved = Moved(speed, dt=dt, position=np.cumsum(speed * dt))
    assert ("no position twice" in str(noise_floor(left(moved, smooth)).why)) == once
    # Rough noise can be told from a torque along the stroke.
    rough = np.random.default_rng(1).standard_normal(size)
    assert "no position twice" not in str(noise_floor(left(moved, rough)).why)
    # Without positions nothing is known of them.
    assert "no position twice" not in str(noise_floor(left(Moved(speed), smooth)).why)


def test_a_floor_is_reached_within_half_of_it() -> None:
    assert NoiseFloor(0.2).is_reached_by(0.2 * REACHED)
    assert not NoiseFloor(0.2).is_reached_by(0.2 * REACHED + 1e-6)
    assert not NoiseFloor(None).is_reached_by(0.0)


def test_features_are_the_channels_that_vary_and_the_direction() -> None:
    rng = np.random.default_rng(6)
    size = 50
    speed = rng.standard_normal(size)
    warm, load = rng.standard_normal(size), 3.0 * rng.standard_normal(size)
    rows = np.arange(0, size, 2)

    def scaled(values: Array) -> Array:
        return (values[rows] - values[rows].mean()) / values[rows].std()

    moved = Moved(speed, temperature=warm, load_torque=load, position=np.full(size, 0.3))
    expected = [scaled(speed), scaled(warm), scaled(load), 3.0 * np.sign(speed[rows])]
    found = state_features(left(moved, speed), rows)
    assert found == pytest.approx(np.column_stack(expected))
    # The load that the model holds replaces one that was not recorded.
    other = state_features(left(Moved(speed, temperature=warm), speed, load=load), rows)
    assert other == pytest.approx(np.column_stack(expected))
    place, push = rng.standard_normal((2, size))
    every = state_features(
        left(Moved(speed, position=place, acceleration=push, dt=np.full(size, 0.1)), speed), rows
    )
    travel = np.sqrt(displacement_since_reversal(Moved(speed, dt=np.full(size, 0.1))))  # type: ignore[arg-type]
    expected = [*map(scaled, (speed, place, push, travel)), 3.0 * np.sign(speed[rows])]
    assert every == pytest.approx(np.column_stack(expected))
