"""Electrical energy: the review's equations 7-11 by hand, and when it is not known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.fitting.energy import (
    Energy,
    Motor,
    electrical_energy,
    electrical_power,
    motor_of,
    total_energy,
)
from synthetic import joint, record

MOTOR = {"km": 0.1, "kb": 0.12, "kt": 0.1, "gear_ratio": 50.0}


def test_power_is_equation_7() -> None:
    """1/km^2 (tau/ir)^2 + kb/kt v tau, term by term."""
    motor = Motor(km=0.2, kb=0.3, kt=0.25, gear_ratio=100.0)
    copper, moved = (40.0 / 100.0) ** 2 / 0.2**2, 0.3 / 0.25 * 1.5 * 40.0
    power = electrical_power(np.array([40.0, -40.0]), np.array([1.5, 1.5]), motor)
    np.testing.assert_allclose(power, [copper + moved, copper - moved], rtol=1e-14)


def test_energy_is_the_integral_over_the_scored_rows(tmp_path: Path) -> None:
    recording = record(tmp_path, joint(), **MOTOR)
    prediction = 0.9 * recording.torque
    energy = electrical_energy(recording, prediction)
    assert energy is not None
    rows, motor = recording.moving, Motor(**MOTOR)
    for torque, found in ((recording.torque, energy.measured), (prediction, energy.modelled)):
        power = (torque / 5.0) ** 2 + 1.2 * recording.velocity * torque
        assert found == pytest.approx(np.sum((power * recording.dt)[rows]), rel=1e-12)
    assert motor_of(recording) == motor
    assert energy.error == energy.measured - energy.modelled > 0.0
    assert energy.error_percent == pytest.approx(100.0 * energy.error / energy.measured)


def test_the_sign_is_the_reviews() -> None:
    """Table 4: Clochiatti spends 772.98 J where 772.57 J were measured, an error of -0.41 J."""
    energy = Energy(measured=772.57, modelled=772.98)
    assert energy.error == pytest.approx(-0.41, abs=1e-9)
    assert round(energy.error_percent, 2) == -0.05


@pytest.mark.parametrize("missing", sorted(MOTOR))
def test_without_a_constant_it_is_not_known(tmp_path: Path, missing: str) -> None:
    known = {name: value for name, value in MOTOR.items() if name != missing}
    recording = record(tmp_path, joint(), **known)
    assert motor_of(recording) is None
    assert electrical_energy(recording, recording.torque) is None


def test_a_screw_turns_speed_into_turns_of_the_motor(tmp_path: Path) -> None:
    frame = joint()
    path = tmp_path / "screw.parquet"
    frame.write_parquet(path)
    path.with_name("screw.parquet.sidecar.toml").write_text(
        'kind = "recording"\njoint_kind = "prismatic"\nscrew_pitch = 0.01\ngear_ratio = 2.0\n'
        "km = 0.1\nkb = 0.1\nkt = 0.1\n"
    )
    motor = motor_of(sb.read(path))
    assert motor is not None
    assert motor.gear_ratio == pytest.approx(2.0 * 2.0 * np.pi / 0.01)


def test_total_is_the_sum_over_joints_or_unknown() -> None:
    parts = [Energy(10.0, 9.0), Energy(5.0, 7.0)]
    assert total_energy(parts) == Energy(15.0, 16.0)
    assert total_energy([*parts, None]) is None
    assert total_energy([]) is None
