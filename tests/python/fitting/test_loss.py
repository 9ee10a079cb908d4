"""Robust losses: outliers, the loss that is minimised, and its standard errors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from numpy.typing import NDArray
from scipy.optimize import least_squares
from stribeck.identify.stated.loss import TUNING
from synthetic import COULOMB, VISCOUS, joint, motion, record

Array = NDArray[np.float64]
LOSSES = ("huber", "cauchy")


def with_outliers(frame: pl.DataFrame, share: float, size: float) -> pl.DataFrame:
    """Torque spikes of one sign in the direction of motion."""
    rng = np.random.default_rng(4)
    struck = rng.random(frame.height) < share
    extra = np.where(struck, size * np.sign(frame["velocity"].to_numpy()), 0.0)
    return frame.with_columns(torque=pl.col("torque") + pl.Series(extra))


@pytest.fixture(scope="module")
def struck(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """One sample in a hundred is 20 N m off."""
    return record(tmp_path_factory.mktemp("loss"), with_outliers(joint(), 0.01, 20.0))


@pytest.mark.parametrize("loss", LOSSES)
def test_outliers_do_not_move_the_parameters(struck: sb.Recording, loss: str) -> None:
    squares = sb.fit("coulomb", struck)
    robust = sb.fit("coulomb", struck, loss=loss)
    truth = {"viscous_friction": VISCOUS, "coulomb_friction": COULOMB}
    for name, e in robust.estimates.items():
        assert abs(e.value - truth[name]) < 2.0 * e.stderr
    e = robust.estimates["coulomb_friction"]
    assert abs(squares.model.value("coulomb_friction") - COULOMB) > 10.0 * e.stderr
    assert robust.to_dict()["loss"] == loss
    assert robust.to_dict()["loss_scale"] == pytest.approx(0.03, rel=0.05)
    assert squares.to_dict()["loss"] == "squares"


@pytest.mark.parametrize("loss", LOSSES)
def test_a_nonlinear_law(tmp_path: Path, loss: str) -> None:
    v = motion()[2]
    curve = 1.2 * np.exp(-np.abs(v / 0.12)) * np.sign(v)
    recording = record(tmp_path, with_outliers(joint(curve), 0.02, 15.0))
    robust = sb.fit("coulomb+stribeck", recording, loss=loss, starts=5)
    squares = sb.fit("coulomb+stribeck", recording, starts=5)
    truth = {"stribeck_height": 1.2, "stribeck_velocity": 0.12, "stribeck_exponent": 1.0}
    for name, value in truth.items():
        e = robust.estimates[name]
        assert abs(e.value - value) < 3.0 * e.stderr
        assert abs(e.value - value) < abs(squares.model.value(name) - value)
    assert robust.converged and robust.to_dict()["kkt_residual"] < 1e-8


@pytest.mark.parametrize("loss", LOSSES)
def test_the_true_loss_is_minimised(struck: sb.Recording, loss: str) -> None:
    """SciPy minimises the same loss at the scale that was found."""
    fitted = sb.fit("coulomb", struck, loss=loss)
    scale = fitted.under.objective.loss.scale
    r = struck
    columns = np.column_stack([r.velocity, np.sign(r.velocity)])[fitted.rows]
    torque = (r.torque - r.load_torque)[fitted.rows]
    end = least_squares(
        lambda x: columns @ x - torque,
        [VISCOUS, COULOMB],
        loss=loss,
        f_scale=TUNING[loss] * scale,
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    assert fitted.model.values == pytest.approx(end.x, rel=1e-7)
    # The scale is that of its own residual.
    residual = np.abs(torque - columns @ fitted.model.values)
    assert scale == pytest.approx(np.median(residual) / 0.67449, rel=1e-4)


@pytest.mark.parametrize("loss", LOSSES)
def test_without_outliers_little_is_lost(plain: sb.Recording, loss: str) -> None:
    """95 % efficiency: standard errors larger by a fortieth, values almost the same."""
    squares = sb.fit("coulomb", plain, errors="independent")
    robust = sb.fit("coulomb", plain, errors="independent", loss=loss)
    for name, e in squares.estimates.items():
        other = robust.estimates[name]
        assert abs(other.value - e.value) < e.stderr
        assert other.stderr == pytest.approx(1.026 * e.stderr, rel=0.03)


@pytest.mark.slow
def test_standard_errors_are_calibrated(tmp_path: Path) -> None:
    found = []
    for seed in range(60):
        frame = with_outliers(joint(rows=1000, seed=seed), 0.0, 0.0)
        rng = np.random.default_rng(seed)
        heavy = 0.05 * rng.standard_t(2.0, frame.height)
        frame = frame.with_columns(torque=pl.col("torque") + pl.Series(heavy))
        e = sb.fit("coulomb", record(tmp_path, frame), loss="huber").estimates["coulomb_friction"]
        found.append((e.value - COULOMB) / e.stderr)
    assert 0.6 < np.mean(np.square(found)) < 1.5


@pytest.mark.parametrize("loss", LOSSES)
def test_held_out_refits_are_robust_too(struck: sb.Recording, loss: str) -> None:
    robust = sb.fit("coulomb", struck, loss=loss)
    good = struck.moving & (np.abs(robust.residual) < 5.0)
    error = np.sqrt(np.mean(robust.held_out_residual[good] ** 2))
    assert error == pytest.approx(0.03, rel=0.05)


def test_exact_data(tmp_path: Path) -> None:
    frame = joint(noise=0.0, velocity_noise=0.0)
    fitted = sb.fit("coulomb", record(tmp_path, frame), loss="cauchy")
    assert fitted.model.values == pytest.approx([VISCOUS, COULOMB], rel=1e-9)


def test_weights_and_a_loss_together(struck: sb.Recording) -> None:
    """Weights of one value change nothing, whatever the value."""
    plain = sb.fit("coulomb", struck, loss="huber")
    weighted = sb.fit("coulomb", struck, loss="huber", weights=np.full(struck.rows, 9.0))
    assert weighted.model.values == pytest.approx(plain.model.values, rel=1e-8)
    for name, e in plain.estimates.items():
        assert weighted.estimates[name].stderr == pytest.approx(e.stderr, rel=1e-6)


def test_the_loop_keeps_the_loss(tmp_path: Path) -> None:
    v = motion()[2]
    curve = 1.2 * np.exp(-np.abs(v / 0.12)) * np.sign(v)
    recording = record(tmp_path, with_outliers(joint(curve), 0.01, 20.0))
    found = sb.improve("coulomb", recording, loss="huber", most_steps=2)
    assert [step.finding.effect for step in found.steps][:1] == ["stribeck"]
    assert found.final.to_dict()["loss"] == "huber"
