"""Fits through a voltage drive."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from servo_recording import TRUTH, recorded
from stribeck import _core
from stribeck.base.errors import FitError, RecordingError, SpecError
from stribeck.cli.main import cli
from stribeck.fitting.evaluate import evaluate
from stribeck.models.drive import VoltageDrive


def test_all_constants_are_found_where_the_servo_is_also_off(whole: sb.Recording) -> None:
    fit = sb.fit("bam_m3", whole, starts=4)
    for estimate in fit.estimates.values():
        assert estimate.identifiable and estimate.stderr is not None
        error = abs(estimate.value - TRUTH[estimate.symbol])
        assert error < 0.05 * TRUTH[estimate.symbol], (estimate.symbol, estimate.value)
    assert [e.unit for e in fit.estimates.values()] == [
        "N m",
        "1",
        "N m s/rad",
        "kg m2",
        "N m/A",
        "ohm",
    ]


def test_driven_rows_alone_give_back_emf_and_viscous_friction_together(
    driven: sb.Recording, whole: sb.Recording
) -> None:
    hidden = {
        name: e.why for name, e in sb.fit("bam_m1", driven).estimates.items() if not e.identifiable
    }
    assert set(hidden) == {"viscous_friction", "torque_constant", "resistance"}
    assert "resistance and torque_constant together" in str(hidden["viscous_friction"])
    assert all(e.identifiable for e in sb.fit("bam_m1", whole).estimates.values())


def test_the_target_is_the_voltage_on_and_nothing_off(whole: sb.Recording) -> None:
    assert whole.enabled is not None and whole.external_torque is not None
    assert whole.torque_unit == "V" and not whole.torque[~whole.enabled].any()
    np.testing.assert_allclose(whole.external_torque, -0.48 * np.sin(whole.position))
    assert whole.columns["load_torque"].unit == "N m"


def test_gradient_is_the_slope_of_the_voltage() -> None:
    drive = VoltageDrive(_core.Model("bam_m4", ["inertia", "delay"]), {})
    rng = np.random.default_rng(3)
    size = 40
    columns = {
        "dt": np.full(size, 0.01),
        "velocity": rng.normal(size=size),
        "acceleration": rng.normal(size=size),
        "load_torque": rng.normal(size=size),
        "external_torque": rng.normal(size=size),
        "enabled": np.arange(size) % 3 > 0,
    }
    start = np.array([p["start"] for p in drive.parameters()])
    values = np.where(start == 0, 0.002, start * 1.1)
    voltage, jacobian = drive.gradient(values, **columns)
    np.testing.assert_array_equal(voltage, drive.torque(values, **columns))
    for k, value in enumerate(values):
        step = 1e-7 * max(abs(value), 1e-2)
        above, below = values.copy(), values.copy()
        above[k] += step
        below[k] -= step
        slope = drive.torque(above, **columns) - drive.torque(below, **columns)
        np.testing.assert_allclose(jacobian[:, k], slope / (2 * step), rtol=1e-5, atol=1e-6)
    some = [len(values) - 1, 0, len(values) - 2]
    np.testing.assert_array_equal(
        drive.gradient(values, **columns, wanted=some)[1], jacobian[:, some]
    )


def test_a_known_torque_constant_is_no_parameter(tmp_path: Path, frame: pl.DataFrame) -> None:
    known = recorded(tmp_path, frame, where="enabled", kt=TRUTH["kt"])
    fit = sb.fit("bam_m3", known, starts=4)
    assert "torque_constant" not in fit.estimates
    assert fit.model.constants["torque_constant"] == TRUTH["kt"]
    assert fit.estimates["resistance"].value == pytest.approx(TRUTH["R"], rel=0.05)
    both = recorded(tmp_path, frame, where="enabled", kt=0.35, km=0.2)
    assert sb.fit("bam_m1", both).model.constants["resistance"] == pytest.approx((0.35 / 0.2) ** 2)


def test_a_model_file_keeps_the_drive_and_its_bits(tmp_path: Path, whole: sb.Recording) -> None:
    fit = sb.fit("bam_m3", whole, starts=4)
    path = tmp_path / "servo.toml"
    fit.model.save(str(path))
    loaded = sb.load(str(path))
    assert loaded.drive == "voltage" and np.array_equal(loaded.values, fit.model.values)
    assert evaluate(loaded, whole).rmse == fit.rmse


def test_torque_speaks_of_friction_alone(whole: sb.Recording) -> None:
    fit = sb.fit("bam_m3", whole, starts=4)
    value = {e.symbol: e.value for e in fit.estimates.values()}
    torque = fit.model.torque([2.0], motor_torque=[0.3], external_torque=[-0.1])
    assert torque[0] == pytest.approx(value["Kc"] + 0.4 * value["Kl"] + 2.0 * value["Kv"])
    friction = fit.model.friction
    assert friction.names == ("coulomb_friction", "load_coulomb", "viscous_friction")
    assert friction.torque_unit == "N m" and friction.drive is None


def test_each_gain_can_be_held_out(tmp_path: Path, frame: pl.DataFrame) -> None:
    gains = recorded(tmp_path, frame, hold_out="gain")
    assert gains.block_count == 3
    assert np.array_equal(gains.block, frame["gain"].to_numpy())
    one = recorded(tmp_path, frame, hold_out="gain=1")
    fit = sb.fit("bam_m3", one, starts=4)
    rows = one.moving & (one.block == 1)
    expected = float(np.sqrt(np.mean(fit.held_out_residual[rows] ** 2)))
    assert fit.rmse_held_out == pytest.approx(expected)


def test_what_cannot_be_driven_is_refused(tmp_path: Path, frame: pl.DataFrame) -> None:
    path = tmp_path / "servo.parquet"
    frame.write_parquet(path)
    options = {"map": ["torque=effort_V"], "unit": ["effort_V=V"], "drive": "voltage"}
    with pytest.raises(RecordingError, match="needs a known load torque"):
        sb.read(path, **options)
    with pytest.raises(RecordingError, match="needs an effort in V, the torque is in N m"):
        sb.read(path, **{**options, "unit": ["effort_V=Nm"]}, inertia=0.005)
    with pytest.raises(RecordingError, match="unknown value; give voltage"):
        sb.read(path, **{**options, "drive": "current"})
    with pytest.raises(RecordingError, match="there is no column 'gains'; did you mean 'gain'"):
        sb.read(path, **options, inertia=0.005, hold_out="gains")
    with pytest.raises(RecordingError, match="no row has gain 7; there are 0, 1, 2"):
        sb.read(path, **options, inertia=0.005, hold_out="gain=7")


def test_models_that_do_not_fit_the_drive_are_refused(whole: sb.Recording) -> None:
    with pytest.raises(SpecError, match="already has an armature_inertia"):
        sb.fit("coulomb+inertia", whole)
    with pytest.raises(FitError, match="depends on the motor torque"):
        sb.fit("bam_m3+presliding", whole)
    plain = sb.model("coulomb", coulomb_friction=1.0, viscous_friction=1.0)
    with pytest.raises(FitError, match=r"predicts a torque, but .* as the voltage on a motor"):
        evaluate(plain, whole)


def test_the_command_drives_and_holds_out(tmp_path: Path, frame: pl.DataFrame) -> None:
    recorded(tmp_path, frame)
    words = ["fit", str(tmp_path / "servo.parquet"), "--drive", "voltage", "--model", "bam_m3"]
    done = CliRunner().invoke(
        cli, [*words, "--starts", "2", "--hold-out", "gain=1", "--where", "enabled", "--json"]
    )
    assert done.exit_code == 0
    said = json.loads(done.stdout)
    assert said["drive"] == "voltage" and said["unit"] == "V"
    assert said["parameters"]["resistance"]["unit"] == "ohm"
    assert said["rmse_held_out"] > 0
    assert "held out: the samples with gain 1, predicted from all others" in said["notes"]


def test_inspect_lists_the_channel_that_switches_the_drive(
    tmp_path: Path, frame: pl.DataFrame
) -> None:
    recorded(tmp_path, frame)
    words = ["inspect", str(tmp_path / "servo.parquet"), "--drive", "voltage", "--json"]
    done = CliRunner().invoke(cli, words)
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["columns"]["enabled"]["unit"] == "1"
