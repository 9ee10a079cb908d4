"""Gaussian priors: the posterior of linear regression, its calibration, and conflicts with data."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from numpy.typing import NDArray
from synthetic import COULOMB, VISCOUS, ar1, joint, record

Array = NDArray[np.float64]


def columns(recording: sb.Recording) -> tuple[Array, Array]:
    """Columns of viscous and Coulomb friction, and the friction torque, of the scored samples."""
    r = recording
    made = np.column_stack([r.velocity, np.sign(r.velocity)])
    return made[r.moving], (r.torque - r.load_torque)[r.moving]


def test_the_posterior_of_linear_regression(plain: sb.Recording) -> None:
    mean, deviation = np.array([1.21, 2.99]), np.array([0.003, 0.001])
    prior = {"a1": (1.21, 0.003), "coulomb_friction": (2.99, 0.001)}
    fitted = sb.fit("coulomb", plain, prior=prior, errors="independent")
    noise = fitted.under.objective.prior.noise
    j, y = columns(plain)
    precision = j.T @ j / noise**2 + np.diag(deviation**-2.0)
    covariance = np.linalg.inv(precision)
    expected = covariance @ (j.T @ y / noise**2 + mean / deviation**2)
    residual = y - j @ expected
    # The noise is that of the residual of the posterior: it was iterated until it stayed.
    assert noise == pytest.approx(np.sqrt(residual @ residual / (y.size - 2)), rel=1e-8)
    assert fitted.model.values == pytest.approx(expected, rel=1e-10)
    errors = [e.stderr for e in fitted.estimates.values()]
    assert errors == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-6)
    assert fitted.covariance.values == pytest.approx(covariance, rel=1e-6)
    assert fitted.to_dict()["priors"]["viscous_friction"] == [1.21, 0.003]


def test_robust_errors_of_white_noise_are_the_same(plain: sb.Recording) -> None:
    prior = {"coulomb_friction": (3.0, 0.001)}
    robust = sb.fit("coulomb", plain, prior=prior)
    textbook = sb.fit("coulomb", plain, prior=prior, errors="independent")
    for name, e in textbook.estimates.items():
        assert robust.estimates[name].stderr == pytest.approx(e.stderr, rel=0.15)


def test_a_prior_determines_what_the_data_does_not(tmp_path: Path) -> None:
    """At one speed only the sum of Coulomb and viscous friction is determined."""
    rng = np.random.default_rng(2)
    time = np.arange(2000) / 100.0
    velocity = np.full(2000, 0.8)
    torque = COULOMB + VISCOUS * velocity + 0.05 * rng.standard_normal(2000)
    frame = pl.DataFrame(
        {"time": time, "velocity": velocity, "torque": torque, "load_torque": 0.0 * time}
    )
    recording = record(tmp_path, frame)
    free = sb.fit("coulomb", recording)
    assert not free.estimates["viscous_friction"].identifiable
    fitted = sb.fit("coulomb", recording, prior={"viscous_friction": (1.2, 0.3)})
    for name, value, error in (("viscous_friction", 1.2, 0.3), ("coulomb_friction", 3.0, 0.24)):
        e = fitted.estimates[name]
        assert e.identifiable and e.value == pytest.approx(value, abs=0.02)
        assert e.stderr == pytest.approx(error, rel=0.02)


@pytest.mark.slow
def test_intervals_are_calibrated_in_noise_with_memory(tmp_path: Path) -> None:
    """Truths drawn from the prior: errors in units of their standard errors have variance 1."""
    deviation, found = 0.02, []
    rng = np.random.default_rng(11)
    for seed in range(60):
        truth = VISCOUS + deviation * rng.standard_normal()
        frame = joint(rows=1500, noise=0.0, seed=seed)
        noise = ar1(rng, 1500, 0.9, 0.2)
        extra = (truth - VISCOUS) * frame["velocity"].to_numpy() + noise
        frame = frame.with_columns(torque=pl.col("torque") + pl.Series(extra))
        recording = record(tmp_path, frame)
        e = sb.fit("coulomb", recording, prior={"a1": (VISCOUS, deviation)}).estimates
        found.append((e["viscous_friction"].value - truth) / e["viscous_friction"].stderr)
        assert e["viscous_friction"].stderr < deviation
    assert 0.6 < np.mean(np.square(found)) < 1.5


def test_a_prior_far_from_the_data_is_named(plain: sb.Recording) -> None:
    near = sb.fit("coulomb", plain, prior={"a1": (1.21, 0.01)})
    assert not any("the prior of" in note for note in near.notes)
    far = sb.fit("coulomb", plain, prior={"a1": (1.5, 0.01)})
    (note,) = [note for note in far.notes if "the prior of" in note]
    assert note.startswith("the prior of viscous_friction, 1.5 +- 0.01, is ")
    assert "standard errors from what the data shows" in note


def test_it_acts_in_held_out_refits(plain: sb.Recording) -> None:
    """A prior that fixes the value: each refit has it too."""
    fitted = sb.fit("coulomb", plain, prior={"a1": (1.3, 1e-7)})
    held = sb.fit("coulomb", plain, fix={"a1": 1.3})
    assert fitted.rmse_held_out == pytest.approx(held.rmse_held_out, rel=1e-4)
    assert fitted.model.values == pytest.approx(held.model.values, rel=1e-4)
