"""Stiffness, backlash, hysteresis and the side of the friction, from two encoders."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
import two_masses
from stribeck.base.errors import FitError
from stribeck.fitting.transmission.measure import Measured, Transmission, measure_transmission
from stribeck.report.transmission import transmission_text

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
STEP_17_BIT = 2.0 * np.pi / 2**17


def read(folder: Path, **sizes: float) -> sb.Recording:
    path = folder / "two.parquet"
    two_masses.recorded(**sizes).write_parquet(path)
    return sb.read(path, gear_ratio=two_masses.RATIO, standstill=True)


def measured(folder: Path, **sizes: float) -> Transmission:
    return measure_transmission(read(folder, **sizes))


@pytest.mark.slow
def test_a_stiff_spring_without_a_gap(tmp_path: Path) -> None:
    made = measured(tmp_path)
    assert made.stiffness.value == pytest.approx(2e4, rel=0.005)
    assert made.backlash.value is None and made.backlash.high is not None
    assert made.backlash.high < 2e-5
    assert made.hysteresis.value is None and made.lag is None


@pytest.mark.parametrize("gap", [2e-4, 1e-3])
@pytest.mark.parametrize("encoder", [{"quantum": STEP_17_BIT}, {"noise": 2e-5}])
@pytest.mark.slow
def test_a_gap_is_measured_through_quantisation_and_noise(
    tmp_path: Path, gap: float, encoder: dict[str, float]
) -> None:
    made = measured(tmp_path, gap=gap, **encoder)
    assert made.backlash.value == pytest.approx(gap, rel=0.05)
    assert made.stiffness.value == pytest.approx(2e4, rel=0.02)


@pytest.mark.long
def test_intervals_hold_the_truth(tmp_path: Path) -> None:
    """Of 20 recordings with their own noise, at least 17 intervals of 95 % hold it."""
    truth = {"stiffness": 2e4, "backlash": 5e-4, "motor_coulomb": 3.0}
    held = dict.fromkeys(truth, 0)
    for seed in range(20):
        made = measured(tmp_path, gap=5e-4, noise=1e-5, torque_noise=0.5, seed=seed)
        for name, value in truth.items():
            found: Measured = getattr(made, name)
            assert found.low is not None and found.high is not None
            held[name] += found.low <= value <= found.high
            assert found.value == pytest.approx(value, rel=0.02)
    assert min(held.values()) >= 17, held


@pytest.mark.slow
def test_friction_has_a_side(tmp_path: Path) -> None:
    """Friction in front of the spring does not wind it up."""
    for motor, joint in ((4.0, 1.0), (1.0, 4.0)):
        made = measured(tmp_path, motor_friction=motor, joint_friction=joint)
        assert made.motor_share == pytest.approx(motor / 5.0, abs=0.02)
        assert made.coulomb.value == pytest.approx(5.0, rel=0.01)
    text = " ".join(transmission_text(made).split())
    assert f"20 % of the {made.coulomb.value:.3g} N m of the joint" in text
    assert "act behind the transmission" in text


@pytest.mark.slow
def test_a_hysteresis_is_no_gap(tmp_path: Path) -> None:
    made = measured(tmp_path, slip=1.5)
    # The loop is not saturated all the time: its mean half width is below 1.5 N m.
    assert made.hysteresis.value is not None and 0.75 < made.hysteresis.value < 1.5
    assert made.backlash.value is None
    both = measured(tmp_path, slip=1.5, gap=5e-4)
    assert both.backlash.value == pytest.approx(5e-4, rel=0.1)


@pytest.mark.slow
def test_a_held_joint_shows_the_spring_alone(tmp_path: Path) -> None:
    made = measured(tmp_path, locked=True, slip=1.0, motor_friction=0.5)
    assert made.stiffness.value == pytest.approx(2e4, rel=0.03)
    assert made.hysteresis.value is not None and 1.0 < made.hysteresis.value < 1.6
    assert "friction of the motor is part of the hysteresis" in str(made.motor_coulomb.why)


@pytest.mark.slow
def test_what_cannot_be_told_is_said(tmp_path: Path) -> None:
    one_sided = measured(tmp_path, offset=60.0, gap=5e-4)
    assert "does not change its sign" in str(one_sided.backlash.why)
    assert one_sided.stiffness.value == pytest.approx(2e4, rel=0.02)
    stiff = measured(tmp_path, stiffness=1e6, quantum=2.0 * np.pi / 2**14)
    assert stiff.stiffness.value is None
    assert "not above the resolution" in str(stiff.stiffness.why)
    unloaded = measured(tmp_path, gravity=0.0, noise=1e-5)
    assert unloaded.stiffness.value is None
    assert "load the joint independently of its speed" in str(unloaded.stiffness.why)
    assert unloaded.stiffness.low is not None and unloaded.stiffness.low < 2e4


def test_without_a_second_encoder(tmp_path: Path) -> None:
    path = tmp_path / "one.parquet"
    two_masses.recorded().drop("motor_position").write_parquet(path)
    with pytest.raises(FitError, match="has no position of the motor"):
        measure_transmission(sb.read(path))
    two_masses.recorded().write_parquet(path)
    with pytest.raises(FitError, match="torque of the motor, which is not recorded"):
        measure_transmission(sb.read(path, gear_ratio=two_masses.RATIO, torque_at="link"))


@pytest.mark.slow
def test_inspect_shows_it(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    two_masses.recorded(gap=5e-4).write_csv(path)
    command = [sys.executable, "-m", "stribeck", "inspect", str(path), "--gear-ratio", "100"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True, timeout=300)
    assert "Transmission (motor minus joint encoder):" in shown.stdout
    assert "backlash: 0.00050" in shown.stdout
    done = subprocess.run([*command, "--json"], capture_output=True, text=True, check=True)
    (row,) = json.loads(done.stdout)["transmissions"]
    assert row["stiffness"]["value"] == pytest.approx(2e4, rel=0.01)
    assert row["motor_share"] == pytest.approx(0.6, abs=0.02)


@pytest.mark.skipif(not DATA.is_dir(), reason="published measurements are not at ../shared/data")
@pytest.mark.parametrize("file", ["A", "B", "C"])
def test_the_industrial_robot(file: str) -> None:
    """Its owners' stiffness lies in every range; ten seconds of it do not determine it."""
    gears = {"1": 256.857, "2": 267.4286, "3": 252.333}
    owners = {"1": 4577800.0, "2": 7518900.0, "3": 4099900.0}
    for joint, gear in gears.items():
        names = {
            "position": f"act_pos_se_deg_{joint}",
            "motor_position": f"act_pos_mot_deg_{joint}",
            "velocity": f"act_vel_se_deg_per_s_{joint}",
            "motor_velocity": f"act_vel_mot_deg_per_s_{joint}",
        }
        path = DATA / "kr300" / f"{file}.mat"
        recording = sb.read(path, joint=joint, map=names, gear_ratio=gear, torque_at="motor")
        made = measure_transmission(recording)
        assert made.stiffness.value is None and made.backlash.value is None
        low, high = made.stiffness.low, made.stiffness.high
        assert low is not None and high is not None and low < owners[joint] < high
