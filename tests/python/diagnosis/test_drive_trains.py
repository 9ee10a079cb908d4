"""Friction that lags, play and twist are found in recordings made by other mathematics."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from drive_trains import TwoInertias, late_stribeck
from stribeck.base.errors import FitError
from synthetic import joint, record


def steps(folder: Path, frame: object) -> dict[str, sb.Fit]:
    """Effects that are added to Coulomb and viscous friction, with the fit after each."""
    found = sb.improve("coulomb", record(folder, frame))  # type: ignore[arg-type]
    return {step.finding.effect: step.after for step in found.steps}


def test_friction_that_looks_at_an_earlier_speed_lags(tmp_path: Path) -> None:
    found = steps(tmp_path, late_stribeck(0.02))
    assert list(found) == ["frictional_lag"]
    model = found["frictional_lag"].model
    assert model.effects == ("stribeck", "frictional_lag")
    assert model.value("frictional_lag") == pytest.approx(0.02, rel=0.2)


@pytest.mark.slow
def test_friction_without_a_lag_has_none(tmp_path: Path) -> None:
    assert list(steps(tmp_path, late_stribeck(0.0))) == ["stribeck"]


def test_a_spring_between_two_inertias_is_elasticity(tmp_path: Path) -> None:
    drive = TwoInertias()
    found = steps(tmp_path, drive.recorded("motor"))
    assert list(found) == ["elasticity"]
    # The motion is measured at the motor, so it is the joint's inertia that is felt.
    expected = -drive.load / drive.stiffness
    assert found["elasticity"].model.value("elasticity") == pytest.approx(expected, rel=0.1)


@pytest.mark.slow
def test_play_between_two_inertias_is_backlash(tmp_path: Path) -> None:
    drive = TwoInertias(play=0.005, stiffness=5000.0, damping=20.0)
    found = steps(tmp_path, drive.recorded("motor"))
    assert next(iter(found)) == "backlash"
    # The load moves freely in the gap: what it lacked is given back.
    assert found["backlash"].model.value("backlash_return") > 0.5
    # A shaft stiff enough for the blows to be short twists too, and nothing else is named.
    assert set(found) <= {"backlash", "elasticity"}
    if "elasticity" in found:
        expected = -drive.load / drive.stiffness
        assert found["elasticity"].model.value("elasticity") == pytest.approx(expected, rel=0.3)


def test_a_lag_without_a_curve_is_refused(plain: sb.Recording) -> None:
    with pytest.raises(FitError, match="add stribeck"):
        sb.fit("coulomb+frictional_lag", plain)


def test_elasticity_without_a_load_torque_is_refused(tmp_path: Path) -> None:
    recording = record(tmp_path, joint().drop("load_torque"))
    with pytest.raises(FitError, match="known beforehand"):
        sb.fit("coulomb+elasticity", recording)


def test_the_second_derivative_of_the_load_is_that_of_the_motion(tmp_path: Path) -> None:
    frame = joint()
    t = frame["time"].to_numpy()
    # A payload is swapped halfway: the load torque jumps, which is no motion.
    load = 5.0 * np.sin(4.0 * t + 0.3) + 9.0 * (t > 0.5 * t[-1])
    recording = record(tmp_path, frame.with_columns(load_torque=load))
    curvature = recording.load_torque_curvature
    assert curvature is not None
    expected = -80.0 * np.sin(4.0 * t + 0.3)
    inside = np.abs(t - 0.5 * t[-1]) > 0.07
    inside[:6] = inside[-6:] = False
    np.testing.assert_allclose(curvature[inside], expected[inside], rtol=1e-3, atol=0.01)
    # At the ends of a stretch differences are one-sided, and no jump is left.
    assert np.abs(curvature - expected).max() < 40.0
