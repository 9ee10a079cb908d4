"""The one filtered figure, and the raw ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.figures import bridged, relative_residual, rms, torque_cutoff, zero_phase
from synthetic import joint, record


def test_rms() -> None:
    assert rms(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5))
    assert np.isnan(rms(np.empty(0)))


def test_filter_keeps_the_motion_and_its_phase(plain: sb.Recording) -> None:
    cutoff = torque_cutoff(plain)
    assert cutoff is not None and 5.0 < cutoff < 0.4 * plain.rate_hz
    smooth = zero_phase(plain, plain.velocity)
    inside = slice(100, -100)
    assert np.abs(smooth - plain.velocity)[inside].max() < 2e-3
    lag = np.argmax(np.correlate(smooth[inside], plain.velocity[inside], "full"))
    assert lag == plain.velocity[inside].size - 1


def test_filter_works_on_both_sides_alike(plain: sb.Recording) -> None:
    """A residual that is a tenth of the torque is a relative residual of a tenth."""
    assert relative_residual(plain, 0.1 * plain.torque) == pytest.approx(0.1, rel=0.02)


def test_white_noise_weighs_less_than_its_size(plain: sb.Recording) -> None:
    noise = np.random.default_rng(0).standard_normal(plain.rows)
    size = rms(plain.torque[plain.moving])
    assert relative_residual(plain, noise) < 0.8 / size


def test_rest_is_bridged(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(velocity_noise=0.01))
    assert not recording.moving.all()
    values = np.where(recording.moving, 1.0, 1e6)
    assert np.all(bridged(recording, values) == 1.0)


def test_cutoff_scales_with_time(tmp_path: Path, plain: sb.Recording) -> None:
    frame = joint()
    slow = record(
        tmp_path,
        frame.with_columns(
            time=frame["time"] * 4.0,
            velocity=frame["velocity"] / 4.0,
            acceleration=frame["acceleration"] / 16.0,
        ),
    )
    cutoff, reference = torque_cutoff(slow), torque_cutoff(plain)
    assert cutoff is not None and reference is not None
    assert cutoff == pytest.approx(reference / 4.0, rel=1e-6)
