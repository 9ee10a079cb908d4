"""`stribeck fit --estimator iv` as a user gives it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from as_user import stribeck

INERTIA, VISCOUS, COULOMB = 0.5, 1.5, 2.0
#: The reference has a name that says nothing.
REFERENCE = ("--map", "reference_position=asked")


@pytest.fixture(scope="module")
def noisy_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A linear axis whose acceleration is a second difference of a noisy position."""
    step = 0.002
    time = np.arange(-1, 15001) * step
    w = np.array([1.6, 4.1])
    position = np.sin(np.outer(time, w)) @ np.array([0.5, 0.2])
    velocity = np.cos(np.outer(time, w)) @ (w * np.array([0.5, 0.2]))
    acceleration = -np.sin(np.outer(time, w)) @ (w * w * np.array([0.5, 0.2]))
    read = position + 2e-5 * np.random.default_rng(2).normal(size=time.size)
    torque = INERTIA * acceleration + VISCOUS * velocity + COULOMB * np.sign(velocity)
    inside = slice(1, -1)
    frame = {
        "time": time[inside],
        "position": read[inside],
        "velocity": (read[2:] - read[:-2]) / (2.0 * step),
        "acceleration": (read[2:] - 2.0 * read[inside] + read[:-2]) / step**2,
        "force_N": torque[inside],
        "asked": position[inside],
    }
    path = tmp_path_factory.mktemp("estimator") / "axis.parquet"
    pl.DataFrame(frame).write_parquet(path)
    return path


def answer(*words: object) -> dict[str, Any]:
    done = stribeck("fit", *words, "--model", "coulomb", "--json")
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert isinstance(made, dict)
    return made


@pytest.mark.slow
def test_both_estimators(noisy_file: Path) -> None:
    squares = answer(noisy_file, *REFERENCE)
    instrumental = answer(noisy_file, *REFERENCE, "--estimator", "iv")
    assert squares["estimator"] == "ls" and instrumental["estimator"] == "iv"
    assert squares["exogeneity"]["biased"]
    assert squares["parameters"]["inertia"]["value"] < 0.5 * INERTIA
    true = {"inertia": INERTIA, "viscous_friction": VISCOUS, "coulomb_friction": COULOMB}
    for name, value in true.items():
        estimate = instrumental["parameters"][name]
        assert abs(estimate["value"] - value) < 4.0 * estimate["stderr"]
    assert any("by instrumental variables" in note for note in instrumental["notes"])
    text = " ".join(stribeck("fit", noisy_file, *REFERENCE, "--model", "coulomb").stdout.split())
    assert "Least squares is biased: its inertia is about" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--estimator", "iv"), "name its column with --map reference_position=COLUMN"),
        ((*REFERENCE, "--estimator", "iv", "--passive"), "omit it, or --passive"),
        (("--estimator", "iv", "--method", "grid"), "--estimator has no effect with --method grid"),
        (("--estimator", "iv", "--stream"), "--estimator needs all samples in memory"),
        (("--estimator", "gmm"), "'gmm' is not one of"),
    ],
)
def test_refusals(noisy_file: Path, words: tuple[str, ...], said: str) -> None:
    done = stribeck("fit", noisy_file, "--model", "coulomb", *words)
    assert done.returncode == 2
    assert said in " ".join(done.stderr.split()) and "Traceback" not in done.stderr


def test_effects_are_compared_by_least_squares(noisy_file: Path) -> None:
    """The error of a fit by instruments would make any effect look like an improvement."""
    recording = sb.read(noisy_file, map=["reference_position=asked"])
    fitted = sb.fit("coulomb", recording, estimator="iv")
    assert fitted.estimator == "iv"
    added = sb.add(fitted, "offset")
    assert added.estimator != "iv"
    squares = sb.add(sb.fit("coulomb", recording), "offset")
    np.testing.assert_allclose(added.model.values, squares.model.values, rtol=1e-6)
