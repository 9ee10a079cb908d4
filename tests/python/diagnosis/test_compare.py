"""Comparisons: figures against numpy, regimes, and what held out means for a model file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.regimes import REVERSAL_WINDOW
from stribeck.fitting.energy import electrical_energy
from synthetic import joint, motion, record

SPECS = ("coulomb", "coulomb+stribeck")


@pytest.fixture(scope="module")
def bent(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve, at rest for a while."""
    t, _, v, _ = motion()
    frame = joint(1.5 * np.sign(v) * np.exp(-np.abs(v) / 0.1))
    still = pl.DataFrame({c: [frame[c][-1]] * 200 for c in frame.columns}).with_columns(
        velocity=pl.lit(0.0),
        acceleration=pl.lit(0.0),
        time=pl.Series(t[-1] + 0.01 * np.arange(1, 201)),
    )
    return record(tmp_path_factory.mktemp("bent"), pl.concat([frame, still]))


@pytest.fixture(scope="module")
def comparison(bent: sb.Recording) -> sb.Comparison:
    """Two models on it."""
    return sb.compare([sb.fit(spec, bent, starts=4) for spec in SPECS], bent)


def test_figures_are_numpys(bent: sb.Recording, comparison: sb.Comparison) -> None:
    moving = bent.moving
    torque = bent.torque[moving]
    for assessed in comparison.models:
        e = (bent.torque - assessed.fit.prediction)[moving]
        assert assessed.rmse == pytest.approx(np.sqrt(np.mean(e**2)), rel=1e-12)
        assert assessed.mean == pytest.approx(e.mean(), rel=1e-9)
        assert assessed.std == pytest.approx(e.std(), rel=1e-12)
        r2 = 1.0 - np.sum(e**2) / np.sum((torque - torque.mean()) ** 2)
        assert assessed.r2 == pytest.approx(r2, rel=1e-12)
        slow = np.abs(bent.velocity[moving])
        quarter = slow <= np.quantile(slow, 0.25)
        low = np.sqrt(np.mean(e[quarter] ** 2))
        assert assessed.rmse_low_speed == pytest.approx(low, rel=1e-3)
        assert assessed.energy is None


def test_every_model_is_scored_on_the_same_rows(
    bent: sb.Recording, comparison: sb.Comparison
) -> None:
    assert comparison.to_dict()["scored"] == bent.scored()
    threshold = bent.scored()["velocity_threshold"]
    speed = np.abs(bent.velocity)
    unknown = np.pad(bent.velocity * bent.velocity_smooth < 0.0, 1)
    expected = (speed > threshold) & ~unknown[:-2] & ~unknown[2:]
    assert np.array_equal(bent.moving, expected)
    assert threshold == pytest.approx(5.0 * bent.velocity_noise, rel=1e-12)
    # The noise put into the velocity, and not what a filter leaves of it.
    assert bent.velocity_noise == pytest.approx(1e-4, rel=0.15)


def test_regimes(bent: sb.Recording, comparison: sb.Comparison) -> None:
    moving, v = bent.moving, bent.velocity
    by_name = {row.regime: row for row in comparison.models[0].regimes}
    assert set(by_name) == {
        "reversal",
        "low_speed",
        "high_speed",
        "cold",
        "hot",
        "start",
        "end",
        "forward",
        "backward",
        "motoring",
        "generating",
        "standstill",
    }
    e = comparison.models[0].fit.residual
    power = bent.torque * v
    temperature = bent.temperature[moving]
    masks = {
        "forward": moving & (v > 0),
        "backward": moving & (v < 0),
        "motoring": moving & (power > 0),
        "generating": moving & (power < 0),
        "standstill": ~moving,
        "cold": moving & (bent.temperature <= np.quantile(temperature, 0.25)),
        "hot": moving & (bent.temperature >= np.quantile(temperature, 0.75)),
        "high_speed": moving & (np.abs(v) >= np.quantile(np.abs(v[moving]), 0.75)),
    }
    for name, mask in masks.items():
        row = by_name[name]
        assert row.rmse == pytest.approx(np.sqrt(np.mean(e[mask] ** 2)), rel=1e-3), name
        assert row.bias == pytest.approx(e[mask].mean(), rel=1e-2, abs=1e-4), name
        share = mask.mean() if name == "standstill" else mask.sum() / moving.sum()
        assert row.share == pytest.approx(share, rel=1e-3), name
    for name in ("low_speed", "high_speed", "start", "end", "cold", "hot"):
        assert by_name[name].share == pytest.approx(0.25, abs=0.02), name
    # A Stribeck curve that is missing shows where the joint is slow.
    assert by_name["low_speed"].rmse > 1.5 * by_name["high_speed"].rmse


def test_reversal_is_near_a_change_of_direction(
    bent: sb.Recording, comparison: sb.Comparison
) -> None:
    t, v = bent.time[:3000], bent.velocity[:3000]
    turns = t[:-1][np.diff(np.sign(v)) != 0]
    near = np.abs(t[:, None] - turns).min(axis=1) <= REVERSAL_WINDOW
    row = next(r for r in comparison.models[0].regimes if r.regime == "reversal")
    share = np.sum(near & bent.moving[:3000]) / bent.moving.sum()
    assert REVERSAL_WINDOW == 0.2 and row.share == pytest.approx(share, rel=0.05)


def test_relative_residual_is_filtered_and_the_cutoff_is_said(
    bent: sb.Recording, comparison: sb.Comparison
) -> None:
    answer = comparison.models[1].fit.to_dict()
    assert answer["relative_residual_cutoff_hz"] > 0
    raw = answer["rmse_held_out"] / np.sqrt(np.mean(bent.torque[bent.moving] ** 2))
    assert 0 < answer["relative_residual"] < raw


def test_a_model_file_is_never_refitted(bent: sb.Recording, tmp_path: Path) -> None:
    """Its held-out figure is null on its own file, even elsewhere, and its error on another."""
    own = sb.fit("coulomb", bent)
    other = record(tmp_path, joint(seed=9), "other")
    copy = tmp_path / "copy.parquet"
    copy.write_bytes(Path(bent.path).read_bytes())
    again = sb.read(copy, joint_kind="revolute")
    assert again.sha256 == bent.sha256 != other.sha256

    same = sb.evaluate(own.model, again, fitted_on=bent.sha256)
    assert same.rmse == pytest.approx(own.rmse, rel=1e-12)
    assert same.rmse_held_out is None and same.relative_residual is None
    assert sb.compare([same], again).to_dict()["models"][0]["rmse_held_out"] is None

    elsewhere = sb.compare([own], other).models[0]
    v = other.velocity
    value = own.model.value
    predicted = (
        other.load_torque + value("viscous_friction") * v + value("coulomb_friction") * np.sign(v)
    )
    error = np.sqrt(np.mean((other.torque - predicted)[other.moving] ** 2))
    assert elsewhere.rmse == pytest.approx(error, rel=1e-12)
    assert elsewhere.rmse_held_out == elsewhere.rmse
    assert elsewhere.fit.model.values.tobytes() == own.model.values.tobytes()


def test_contract_keys(comparison: sb.Comparison) -> None:
    answer = json.loads(json.dumps(comparison.to_dict()))
    assert {"data", "models", "noise_floor", "scored"} <= set(answer)
    for row in answer["models"]:
        assert {
            "model",
            "rmse",
            "rmse_held_out",
            "relative_residual",
            "mean",
            "std",
            "r2",
            "rmse_low_speed",
            "energy",
            "regimes",
        } <= set(row)
        for regime in row["regimes"]:
            assert set(regime) == {"regime", "share", "rmse", "bias"}
    assert [row["model"] for row in answer["models"]] == list(SPECS)
    assert comparison.to_frame().height == sum(1 + len(m.regimes) for m in comparison.models)


def test_energy_is_null_without_power(tmp_path: Path) -> None:
    """Volts times speed is no work."""
    motor = {"km": 0.1, "kb": 0.1, "kt": 0.1, "gear_ratio": 100.0}
    recording = record(tmp_path, joint().drop("load_torque"), unit=("torque=V",), **motor)
    assert sb.compare([sb.fit("coulomb", recording)], recording).models[0].energy is None


def test_energy_needs_the_motor(tmp_path: Path) -> None:
    """With its constants the energy is that of `stribeck.energy`, in the contract's keys."""
    motor = {"km": 0.1, "kb": 0.12, "kt": 0.1, "gear_ratio": 100.0}
    recording = record(tmp_path, joint(), **motor)
    fitted = sb.fit("coulomb", recording)
    energy = sb.compare([fitted], recording).models[0].energy
    expected = electrical_energy(recording, fitted.prediction)
    assert energy is not None and expected is not None
    assert {"measured_J", "model_J", "error_percent"} <= set(energy)
    assert energy["measured_J"] == expected.measured > 0.0
    assert energy["model_J"] == expected.modelled
    everything = sb.compare([fitted], recording).models[0].energy_all_rows
    rest = electrical_energy(recording, fitted.prediction, ~recording.moving)
    assert everything is not None and rest is not None
    assert everything["measured_J"] == pytest.approx(expected.measured + rest.measured)


def test_mean_and_largest_absolute_errors(tmp_path: Path) -> None:
    recording = record(tmp_path, joint())
    fitted = sb.fit("coulomb", recording)
    row = sb.compare([fitted], recording).models[0].to_dict()
    size = np.abs(fitted.residual[recording.moving])
    assert row["mean_absolute_error"] == pytest.approx(size.mean())
    assert row["largest_absolute_error"] == size.max()
