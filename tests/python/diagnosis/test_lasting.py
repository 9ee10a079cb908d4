"""The part of a residual that lasts longer than noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.lasting import lasting_square
from synthetic import Array, ar1, joint, record

RATE, ROWS, NOISE = 100.0, 6000, 0.03
#: A torque that takes a new value every 3 s.
STEPS = 2 * NOISE * np.repeat(np.random.default_rng(1).standard_normal(ROWS // 300), 300)


def lasting(tmp_path: Path, extra: Array | float) -> float:
    """What lasts of the residual, relative to the mean square of the white noise."""
    fit = sb.fit("coulomb", record(tmp_path, joint(extra, rows=ROWS, noise=NOISE)))
    return lasting_square(fit) / NOISE**2


def test_noise_of_a_sensor_does_not_last(tmp_path: Path) -> None:
    assert lasting(tmp_path, 0.0) < 0.05
    # As behind a filter: forgotten after 30 ms.
    filtered = ar1(np.random.default_rng(2), ROWS, np.exp(-1.0 / (0.03 * RATE)), 2 * NOISE)
    assert lasting(tmp_path, filtered) < 0.2


def test_a_vibration_does_not_last(tmp_path: Path) -> None:
    time = np.arange(ROWS) / RATE
    assert lasting(tmp_path, 2 * NOISE * np.sin(2 * np.pi * 9.0 * time)) < 0.2


def test_a_torque_that_keeps_its_value_lasts(tmp_path: Path) -> None:
    # A tenth of the pairs of samples 0.3 s apart have a step between them.
    assert lasting(tmp_path, STEPS) == pytest.approx(0.9 * np.var(STEPS) / NOISE**2, rel=0.25)


def test_it_is_structure_though_no_channel_explains_it(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(STEPS, rows=ROWS, noise=NOISE))
    found = sb.diagnose(sb.fit("coulomb", recording))
    assert found.verdict == "unexplained"
    assert found.unexplained.share is not None and found.unexplained.share > 0.4


def test_a_slow_oscillation_lasts(tmp_path: Path) -> None:
    # As a payload swings: its autocovariance is negative a quarter of a second later.
    time = np.arange(ROWS) / RATE
    assert lasting(tmp_path, 4 * NOISE * np.sin(2 * np.pi * 1.7 * time)) > 0.3 * 8.0


@pytest.mark.parametrize("hertz", [0.5, 0.56, 0.83, 1.2])
def test_no_slow_oscillation_is_overlooked(tmp_path: Path, hertz: float) -> None:
    # The mean autocovariance from 0.2 to 0.4 s is zero at 0.83 Hz, that from 0.3 to 0.6 s at 0.56.
    time = np.arange(ROWS) / RATE
    assert lasting(tmp_path, 4 * NOISE * np.sin(2 * np.pi * hertz * time)) > 0.3 * 8.0


def test_another_joint_that_moves_is_no_noise(tmp_path: Path) -> None:
    """Its torque is in no channel, so that repeats of a state differ as any two samples do."""
    time = np.arange(ROWS) / RATE
    other = 4 * NOISE * np.sign(np.sin(2 * np.pi * 0.83 * time + 2.0 * np.sin(0.7 * time)))
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(other, rows=ROWS, noise=NOISE))))
    assert found.noise_floor.value is None and "motion of other joints" in str(
        found.noise_floor.why
    )
    assert found.verdict == "unexplained"


def test_what_was_not_tested_is_not_denied(tmp_path: Path) -> None:
    """A pump that turns in one direction passes no state twice, so that no regressor learns."""
    t = np.arange(12000) / 200.0
    v = 60.0 + 30.0 * np.sin(2.0 * np.pi * t / 11.0) + 10.0 * np.sin(2.0 * np.pi * t / 3.1)
    noise = ar1(np.random.default_rng(3), t.size, 0.9, 0.02)
    torque = 1.0 + 0.02 * v + 0.004 * np.gradient(v, t) + noise + 0.05 * np.sin(t / 7.5)
    pump = sb.Recording.from_columns(time=t, velocity=v, torque=torque, load_torque=0.0 * t)
    found = sb.diagnose(sb.fit("coulomb", pump))
    assert "inertia" in [finding.effect for finding in found.findings]
    assert found.explainable is None and found.unexplained.where is not None
    assert "this motion does not tell whether it depends on" in found.unexplained.where
    assert "no function" not in repr(found)
