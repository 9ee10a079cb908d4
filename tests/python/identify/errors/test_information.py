"""AIC and BIC of fits with correlated residuals."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.identify.errors.information import effective_samples, information
from synthetic import ar1, joint, motion, record


def test_the_criteria_are_those_of_the_likelihood() -> None:
    """With m = n they are -2 ln L + 2 k and -2 ln L + k ln n, but for a constant of the data."""
    rng = np.random.default_rng(2)
    residual = 0.3 * rng.standard_normal(500)
    n, k = residual.size, 4
    sigma = np.sqrt(np.mean(residual**2))
    log_likelihood = np.sum(-0.5 * (residual / sigma) ** 2 - np.log(sigma * np.sqrt(2.0 * np.pi)))
    constant = n * (1.0 + math.log(2.0 * math.pi))
    found = information(residual, k - 1, float(n))
    assert found is not None and found.parameters == k
    assert found.aic == pytest.approx(-2.0 * log_likelihood + 2.0 * k - constant)
    assert found.bic == pytest.approx(-2.0 * log_likelihood + k * math.log(n) - constant)


def test_correlated_samples_count_less() -> None:
    noise = ar1(np.random.default_rng(0), 50_000, 0.9, 1.0)
    assert effective_samples(noise) == pytest.approx(50_000 / 19.0, rel=0.15)


def test_no_residual_has_no_criteria() -> None:
    assert information(np.zeros(10), 2) is None
    assert information(np.zeros(0), 2) is None


def bend(v: np.ndarray) -> np.ndarray:
    return 1.5 * np.sign(v) * np.exp(-np.abs(v) / 0.1)


def test_a_fit_and_a_comparison_have_them(tmp_path: Path) -> None:
    """The criteria of a comparison are for the same samples and the same effective number."""
    recording = record(tmp_path, joint(bend(motion()[2]), noise=0.1, rho=0.8))
    fits = [sb.fit(spec, recording, starts=3) for spec in ("coulomb", "coulomb+stribeck")]
    said = fits[1].to_dict()
    found = fits[1].information
    assert found is not None and fits[1].rank == 5 and found.parameters == 6
    assert (said["aic"], said["bic"]) == (found.aic, found.bic)
    assert said["effective_samples"] == effective_samples(fits[1].residual[fits[1].rows])
    compared = sb.compare(fits, recording)
    first, second = (a.information for a in compared.models)
    assert first is not None and second is not None
    assert second == found
    assert (first.samples, first.effective) == (second.samples, second.effective)
    assert first.aic > second.aic and first.bic > second.bic
    assert "ΔAIC" in repr(compared) and "ΔAIC" not in repr(sb.compare(fits[:1], recording))


def test_an_effect_without_substance_raises_them(tmp_path: Path) -> None:
    """The height of a Stribeck curve that is not there fits noise; BIC is stricter than AIC."""
    recording = record(tmp_path, joint(noise=0.1, rho=0.8))
    fits = [sb.fit(spec, recording, starts=3) for spec in ("coulomb", "coulomb+stribeck")]
    first, second = (a.information for a in sb.compare(fits, recording).models)
    assert first is not None and second is not None
    assert second.bic > first.bic
    assert second.bic - first.bic > second.aic - first.aic


def test_a_model_that_was_not_refitted_has_no_fitted_parameter(tmp_path: Path) -> None:
    fit = sb.fit("coulomb", record(tmp_path, joint()))
    other = record(tmp_path, joint(seed=7), "other")
    found = sb.evaluate(fit.model, other).information
    assert found is not None and found.parameters == 1
    same = sb.evaluate(fit.model, fit.recording, fitted_on=fit.recording.sha256)
    assert same.information is None and same.to_dict()["aic"] is None


def test_weights_are_those_of_the_likelihood(tmp_path: Path) -> None:
    """Samples without weight do not count, and their noise has no influence."""
    frame = joint(noise=0.1)
    use = np.arange(frame.height) < 2000
    wild = frame.with_columns(
        torque=pl.when(pl.Series(use)).then(pl.col("torque")).otherwise(pl.col("torque") * 3.0),
        use=pl.Series(use.astype(float)),
    )
    all_samples = sb.fit("coulomb", record(tmp_path, wild, "all", weights="use"))
    some = sb.fit("coulomb", record(tmp_path, wild.filter(pl.col("use") > 0), "some"))
    assert all_samples.information is not None and some.information is not None
    assert all_samples.information.samples == some.information.samples
    assert all_samples.information.aic == pytest.approx(some.information.aic, rel=0.02)


@pytest.mark.slow
def test_the_commands_say_them(tmp_path: Path) -> None:
    joint(bend(motion()[2])).write_parquet(tmp_path / "bend.parquet")

    def run(command: str, *words: str) -> str:
        full = [sys.executable, "-m", "stribeck", command, "bend.parquet", *words]
        done = subprocess.run(full, cwd=tmp_path, capture_output=True, text=True, check=True)
        return done.stdout

    options = ("--starts", "2", "--joint-kind", "revolute")
    fitted = json.loads(run("fit", "--model", "coulomb", *options, "--json"))
    assert fitted["aic"] < fitted["bic"] and fitted["effective_samples"] <= 3000
    assert "effective samples: " in run("fit", "--model", "coulomb", *options)
    compared = json.loads(run("compare", "coulomb", "coulomb+stribeck", *options, "--json"))
    first, second = compared["models"]
    assert first["aic"] > second["aic"]
    assert first["effective_samples"] == second["effective_samples"]
    assert "ΔBIC" in run("compare", "coulomb", "coulomb+stribeck", *options)
