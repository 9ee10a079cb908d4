"""Which samples move: five times the noise of the velocity, or the resolution of the recording."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
import scipy
import stribeck as sb
from stribeck.diagnosis.inspect import inspect
from stribeck.recording.derive import Smoother
from stribeck.recording.load import read
from stribeck.recording.motion.derived_motion import filtered_noise
from stribeck.recording.rows import noise_level, slope_noise
from stribeck.report.inspection import inspection_text

from .conftest import DATA, SIDECARS, joint


def _moves(rate: float, seconds: float, speed: float = 0.3, resting: float = 2.0):
    """Moves of trapezoidal speed with rests between them: time, position, velocity."""
    rng = np.random.default_rng(0)
    fine, parts, elapsed = 1e-3, [], 0.0
    while elapsed < seconds:
        top = speed * rng.uniform(0.3, 1.0)
        ramp = np.arange(0.0, top / 0.6, fine) * 0.6
        flat = np.full(int(rng.uniform(0.3, 1.0) / top / fine), top)
        rest = np.zeros(int(resting * rng.uniform(0.5, 1.5) / fine))
        part = rng.choice([-1.0, 1.0]) * np.concatenate([ramp, flat, ramp[::-1], rest])
        parts.append(part)
        elapsed += part.size * fine
    velocity = np.concatenate(parts)
    every = int(1.0 / (rate * fine))
    time, position = np.arange(velocity.size) * fine, np.cumsum(velocity) * fine
    return time[::every], position[::every], velocity[::every]


def _frame(time, position, velocity) -> pl.DataFrame:
    torque = 3.0 * np.sign(velocity) + 2.0 * velocity
    torque += 0.05 * np.random.default_rng(1).standard_normal(time.size)
    return pl.DataFrame({"time": time, "position": position, "torque": torque})


@pytest.mark.parametrize("rate", [10.0, 50.0, 250.0])
@pytest.mark.parametrize("step", [0.0, 1e-6, 1e-4])
def test_a_slow_robot_with_positions_without_noise(write, rate, step):
    """The velocity rings where the motion begins and ends: samples at rest do not move for that."""
    time, position, velocity = _moves(rate, 200.0)
    if step:
        position = np.round(position / step) * step
    recording = read(write(_frame(time, position, velocity)))
    rest, fast = velocity == 0.0, np.abs(velocity) > 0.06
    assert recording.moving[rest].mean() < 0.02
    assert recording.moving[fast].mean() > 0.97


@pytest.mark.parametrize("kind", ["linear", "cubic"])
def test_resampling_does_not_hide_the_noise(kind):
    """Noise that is interpolated is smooth from sample to sample."""
    rng = np.random.default_rng(2)
    time = np.arange(4000) / 50.0
    noisy = np.sin(0.7 * time) + 1e-3 * rng.standard_normal(time.size)
    fine = np.arange(0.0, time[-1], 1.0 / 200.0)
    resampled = scipy.interpolate.interp1d(time, noisy, kind=kind)(fine)
    segment = np.zeros(fine.size, dtype=np.int64)
    assert noise_level(fine, resampled, segment) == pytest.approx(1e-3, rel=0.5)


def test_noise_that_is_white_is_as_before():
    rng = np.random.default_rng(3)
    time = np.arange(4000) / 100.0
    signal = np.sin(2.0 * time) + 1e-3 * rng.standard_normal(time.size)
    segment = np.zeros(time.size, dtype=np.int64)
    assert noise_level(time, signal, segment) == pytest.approx(1e-3, rel=0.05)
    slope = slope_noise(time, signal, segment, 0.01)
    assert slope == pytest.approx(np.sqrt(2.0) * 1e-3 / 0.01, rel=0.05)


@pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data")
def test_the_filtered_position_of_emps_has_noise():
    """Its pulse file is low-passed: the last digits say nothing of how well the slope is known."""
    name = DATA / "emps" / "emps_pulses.parquet"
    recording = read(name, sidecar=SIDECARS / "emps_pulses.sidecar.toml")
    assert 5e-6 < recording.velocity_noise < 1e-3


def test_the_threshold_may_be_given(write):
    path = write(joint())
    recording = read(path, moving_above=0.5)
    assert recording.velocity_threshold == 0.5
    np.testing.assert_array_equal(recording.moving, np.abs(recording.velocity) > 0.5)
    assert any("samples faster than 0.5 rad/s move, as given" in n for n in recording.notes)
    assert sb.fit("coulomb", recording, starts=1).to_dict()["scored"]["velocity_threshold"] == 0.5
    with pytest.raises(sb.RecordingError, match="must not be negative"):
        read(path, moving_above=-1.0)


def test_a_cut_off_above_the_samples_is_not_said(write):
    """Fast motion sampled slowly: the acceleration is not filtered, and no filter is named."""
    time = np.arange(2000) / 66.7
    position = 0.3 * np.sin(2.0 * np.pi * 9.0 * time) + 0.2 * np.sin(2.0 * np.pi * 13.0 * time)
    velocity = 2.0 * np.pi * 2.7 * np.cos(2.0 * np.pi * 9.0 * time)
    recording = read(write(_frame(time, position, velocity)))
    said = [note for note in recording.notes if "derived" in note]
    assert said and all("no filter" in note for note in said)


def test_dates_and_times_as_texts(write):
    frame = joint()
    stamps = pl.datetime_range(
        pl.datetime(2026, 11, 23, 12), pl.datetime(2026, 11, 23, 13), "5ms", eager=True
    )[: len(frame)]
    for form in ("%Y-%m-%d %H:%M:%S%.6f", "%Y-%m-%dT%H:%M:%S%.3fZ"):
        path = write(frame.with_columns(time=stamps.dt.to_string(form)), "x.csv")
        recording = read(path)
        np.testing.assert_allclose(recording.time, frame["time"].to_numpy(), atol=1e-9)
        assert all(check.ok for check in recording.checks)


def test_what_does_not_move_is_inspected_all_the_same(write):
    still = joint().with_columns(velocity=pl.lit(0.0))
    shown = inspect(str(write(still)))
    assert shown.problem is not None and "does not" in shown.problem and shown.testable == ()
    (wrong,) = [c for c in shown.checks if c.check == "velocity"]
    assert not wrong.ok and "does not" in inspection_text(shown)


def test_few_scored_samples_are_told_with_a_threshold_that_scores_more(write):
    time, position, velocity = _moves(200.0, 100.0, speed=1.0)
    coarse = np.round(position / 1.5e-3) * 1.5e-3
    recording = read(write(_frame(time, coarse, velocity)))
    told = [note for note in recording.notes if "of the samples are scored" in note]
    assert len(told) == 1
    lower = float(told[0].split("moving_above=")[1].split("`")[0])
    again = read(write(_frame(time, coarse, velocity)), moving_above=lower)
    assert again.moving.mean() > 2.0 * recording.moving.mean()
    fast = np.abs(velocity) > 2.0 * lower
    assert again.moving[fast].mean() > 0.99
    fine = read(write(_frame(time, position, velocity)))
    assert not any("of the samples are scored" in note for note in fine.notes)


def test_the_noise_that_a_low_pass_leaves_in_a_derivative():
    time = np.arange(20000) / 200.0
    segment = np.zeros(time.size, dtype=np.int64)
    noise = 2e-3 * np.random.default_rng(0).standard_normal(time.size)
    left = Smoother(time, segment, 10.0).smooth(noise, 1)
    # The filter is not steep: noise above its cut-off adds to it.
    assert np.std(left[200:-200]) == pytest.approx(filtered_noise(2e-3, 0.005, 10.0), rel=0.3)
    assert filtered_noise(2e-3, 0.005, None) is None
