"""Friction that lags, play and twist are found in recordings made by other mathematics."""

from __future__ import annotations

from pathlib import Path

import nlopt
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from drive_trains import NOISE, RATE, TwoInertias, late_stribeck, reference
from stribeck.base.errors import FitError
from stribeck.benchmark.distortion import distorted
from stribeck.benchmark.generators import GENERATORS
from stribeck.effect import hardening
from stribeck.effect.describe import where
from stribeck.effect.resonance import best_resonance
from stribeck.recording.motion.derived_motion import acceleration_cutoff
from stribeck.recording.motion.spring_torque import Resonance
from stribeck.report.finding_view import finding_view
from synthetic import joint, motion, record


def steps(folder: Path, frame: object) -> dict[str, sb.Fit]:
    """Effects that are added to Coulomb and viscous friction, with the fit after each."""
    found = sb.improve("coulomb", record(folder, frame))  # type: ignore[arg-type]
    return {step.finding.effect: step.after for step in found.steps}


@pytest.mark.slow
def test_friction_that_looks_at_an_earlier_speed_lags(tmp_path: Path) -> None:
    found = steps(tmp_path, late_stribeck(0.02))
    assert list(found) == ["frictional_lag"]
    model = found["frictional_lag"].model
    assert model.effects == ("stribeck", "frictional_lag")
    assert model.value("frictional_lag") == pytest.approx(0.02, rel=0.2)


def test_a_lag_below_a_sample_is_as_likely_as_not(tmp_path: Path) -> None:
    found = sb.improve("coulomb", record(tmp_path, late_stribeck(0.005)))
    assert found.final.model.spec == "coulomb+stribeck+frictional_lag"
    curve, lag = (step.finding for step in found.steps)
    assert curve.confidence > 0.9 and not curve.indistinguishable_from
    assert lag.confidence <= 0.5 and "less than the 10 ms between samples" in lag.where
    assert found.final.model.value("frictional_lag") == pytest.approx(0.005, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [5, 6])
def test_a_late_load_torque_is_no_lag_within_a_sample(tmp_path: Path, seed: int) -> None:
    """Alone (5), and beside a delay that shifts all friction forward (6), a lag imitates it."""
    made = GENERATORS["closed_loop"].make(("stribeck",), seed, 5.0)
    found = steps(tmp_path, distorted(made, ("sensor_lag",), seed).frame)
    assert next(iter(found)) == "stribeck" and "frictional_lag" not in found


@pytest.mark.slow
def test_friction_without_a_lag_has_none(tmp_path: Path) -> None:
    assert list(steps(tmp_path, late_stribeck(0.0))) == ["stribeck"]


@pytest.mark.slow
def test_a_spring_between_two_inertias_is_elasticity(tmp_path: Path) -> None:
    drive = TwoInertias()
    found = steps(tmp_path, drive.recorded("motor"))
    assert list(found) == ["elasticity"]
    # The motion is measured at the motor, so it is the joint's inertia that is felt.
    expected = -drive.load / drive.stiffness
    assert found["elasticity"].model.value("elasticity") == pytest.approx(expected, rel=0.1)


@pytest.mark.slow
def test_a_load_that_oscillates_on_its_spring_is_elasticity_with_a_resonance(
    tmp_path: Path,
) -> None:
    drive = TwoInertias()
    # Without the start, at which the simulated spring is slack.
    found = steps(tmp_path, drive.recorded("motor", seen=True)[400:])
    first = next(iter(found))
    assert first == "elasticity"
    model = found[first].model
    assert 1.0 / model.constants["resonance_period"] == pytest.approx(drive.resonance(), rel=0.1)
    # Of the whole load torque only the part of the joint oscillates.
    share = drive.load / (drive.motor + drive.load)
    expected = -share * drive.load / drive.stiffness
    assert model.value("elasticity") == pytest.approx(expected, rel=0.2)
    plain = sb.fit("coulomb", found[first].recording)
    assert found[first].rmse_held_out < 0.4 * plain.rmse_held_out
    assert "torque in the drive train's spring" in finding_view(first, plain, found[first]).x_label


def test_a_lower_cutoff_removes_noise_and_no_motion(tmp_path: Path) -> None:
    """However closely the torque follows the slow part of an acceleration."""
    r = record(tmp_path, TwoInertias().recorded("motor", seen=True)[400:])
    usual = acceleration_cutoff(r.time, r.velocity, r.segment, 1.0 / RATE, r.cutoff_hz)
    assert r.acceleration_filter is not None and r.acceleration_filter.cutoff == usual


@pytest.mark.slow
def test_a_spring_that_hardens_is_told_from_the_inertia_of_the_motor(tmp_path: Path) -> None:
    drive = TwoInertias(motor=0.35, load=0.65, stiffness=600.0, damping=3.2, hardening=0.01)
    frame = drive.recorded("motor", seen=True)[400:]
    found = steps(tmp_path, frame)
    assert list(found) == ["elasticity"]
    after = found["elasticity"]
    resonance = Resonance.of(after.model.core.constants)
    assert 1.0 / resonance.period == pytest.approx(drive.resonance(), rel=0.05)
    assert resonance.hardening == pytest.approx(drive.stiffness * drive.hardening, rel=0.1)
    assert resonance.motor_inertia == pytest.approx(drive.motor, rel=0.1)
    assert after.model.value("elasticity") == pytest.approx(-drive.load / drive.stiffness, rel=0.1)
    plain = sb.fit("coulomb", after.recording)
    assert after.rmse_held_out < 0.4 * plain.rmse_held_out
    # No linear spring does as well.
    simple = best_resonance(after.recording, plain.residual).constants
    linear = plain.model.with_effect("elasticity", simple)
    assert after.rmse_held_out < 0.6 * sb.fit(linear, after.recording, starts=1).rmse_held_out
    said = where("elasticity", plain, after)
    assert "of the motor" in said
    assert "its spring hardens: under" in said and said.endswith("% less than a linear one")


def test_a_search_that_fails_leaves_the_linear_spring(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    class Stuck(nlopt.opt):
        def optimize(self, start: object) -> object:
            asked.append(start)
            raise nlopt.RoundoffLimited

    monkeypatch.setattr(hardening.nlopt, "opt", Stuck)
    frame = TwoInertias().recorded("motor", rows=2000, seen=True)[400:]
    recording = record(tmp_path, frame)
    assert hardening.detailed_resonance(recording).hardening == 0.0
    assert len(asked) >= 2


def test_values_of_an_elasticity_keep_the_resonance_they_came_with(tmp_path: Path) -> None:
    recording = record(tmp_path, TwoInertias().recorded("motor", rows=1000, seen=True))
    values = {"coulomb_friction": 4.0, "viscous_friction": 2.0, "elasticity": -1e-4}
    rigid = sb.model("coulomb+elasticity", **values)
    stated = sb.evaluate(rigid, recording).model.core.constants["resonance_period"]
    assert stated == 0.0


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


def direct_drive(lacking: float, seed: int = 3, rows: int = 4000) -> pl.DataFrame:
    """A motor on the axis of an unbalanced arm: its load torque lacks some inertia in kg m2."""
    t = np.arange(rows) / 100.0
    q, v, a = reference(t)
    noise = np.random.default_rng(seed)
    load = 0.3 * a + 2.0 * np.sin(q)
    friction = 0.4 * np.sign(v) + 0.12 * v
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v + 1e-4 * noise.standard_normal(rows),
            "torque": load + lacking * a + friction + NOISE * noise.standard_normal(rows),
            "load_torque": load,
        }
    )


def test_a_wrong_inertia_is_no_elasticity_and_no_position(tmp_path: Path) -> None:
    """On sines, acceleration is nearly proportional to position."""
    found = steps(tmp_path, direct_drive(0.05))
    assert list(found) == ["inertia"]
    assert found["inertia"].model.value("inertia") == pytest.approx(0.05, rel=0.05)


def test_a_small_ripple_is_no_spring(tmp_path: Path) -> None:
    """Eight periods of 0.03 N m, the RMS of the noise, in the range of the motion."""
    found = steps(tmp_path, joint(0.03 * np.sqrt(2.0) * np.sin(20.0 * motion()[1] + 0.3)))
    assert list(found) == ["ripple"]
