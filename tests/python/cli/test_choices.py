"""Starts, bounds and fixed values in every fitting command, as a user gives them."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from as_user import answer, stribeck
from synthetic import joint, motion


@pytest.fixture(scope="module")
def curve_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A joint with a Stribeck curve of 1.2 N m at 0.12 rad/s."""
    v = motion()[2]
    path = tmp_path_factory.mktemp("choices") / "joint.parquet"
    joint(1.2 * np.exp(-np.abs(v / 0.12)) * np.sign(v)).write_parquet(path)
    return path


@pytest.mark.slow
def test_fit_ends_at_a_bound_and_says_what_to_do(curve_file: Path) -> None:
    fit = ["fit", curve_file, "--model", "coulomb", "--bound", "viscous_friction=0.1:0.5"]
    made = answer(*fit)
    assert made["parameters"]["viscous_friction"]["value"] == 0.5
    advice = (
        "viscous_friction is at its upper bound 0.5 N m s/rad: widen it with --bound "
        "viscous_friction=0.1:2.5, or the recording does not determine it"
    )
    assert advice in made["notes"]
    assert advice in " ".join(stribeck(*fit).stdout.split())


def test_the_same_with_the_data_read_in_passes(curve_file: Path) -> None:
    fit = [
        "fit",
        curve_file,
        "--stream",
        "--model",
        "coulomb",
        "--bound",
        "viscous_friction=0.1:0.5",
    ]
    made = answer(*fit, "--fix", "a2=3")
    assert made["parameters"]["viscous_friction"]["value"] == 0.5
    assert made["parameters"]["coulomb_friction"]["value"] == 3.0
    assert any("--bound viscous_friction=0.1:2.5" in note for note in made["notes"])


@pytest.mark.slow
def test_compare_holds_them_where_a_model_has_the_parameter(curve_file: Path) -> None:
    compare = ["compare", curve_file, "coulomb", "coulomb+stribeck"]
    free, held = answer(*compare), answer(*compare, "--fix", "stribeck_height=0.4")
    assert [row["model"] for row in held["models"]] == ["coulomb", "coulomb+stribeck"]
    assert held["models"][0]["rmse"] == free["models"][0]["rmse"]
    assert held["models"][1]["rmse"] > 1.5 * free["models"][1]["rmse"]
    done = stribeck(*compare, "--fix", "stribeck_hight=0.4")
    assert done.returncode == 2 and done.stdout == ""
    assert "no model that is fitted has a parameter 'stribeck_hight'" in done.stderr
    assert "did you mean 'stribeck_height'?" in done.stderr


@pytest.mark.slow
def test_diagnose_holds_a_parameter_of_an_effect_that_it_tries(curve_file: Path) -> None:
    diagnose = ["diagnose", curve_file, "coulomb"]
    free = answer(*diagnose)["findings"][0]
    held = answer(*diagnose, "--bound", "stribeck_height=0:0.3")
    assert free["effect"] == "stribeck"
    of_stribeck = [f for f in held["findings"] if f["effect"] == "stribeck"]
    # At its bound the height of the curve is implausible, so that the effect is no finding.
    assert of_stribeck == []


def test_add_takes_choices_of_the_model_and_of_the_effect(curve_file: Path) -> None:
    made = answer(
        *("add", "coulomb", "stribeck", curve_file),
        *("--fix", "viscous_friction=1.2", "--bound", "stribeck_velocity=0.15:0.3"),
    )
    found = made["parameters"]
    assert found["viscous_friction"]["held"] and found["viscous_friction"]["value"] == 1.2
    assert 0.15 <= found["stribeck_velocity"]["value"] <= 0.3


@pytest.mark.slow
def test_improve_keeps_them_in_force(curve_file: Path) -> None:
    made = answer(
        *("improve", curve_file, "--base", "coulomb", "--max-steps", 2),
        *("--fix", "viscous_friction=1.3", "--bound", "stribeck_exponent=1.5:2"),
    )
    assert "stribeck" in made["final"]["model"]
    for step in made["steps"]:
        assert step["parameters"]["viscous_friction"]["value"] == 1.3
    assert 1.5 <= made["final"]["parameters"]["stribeck_exponent"]["value"] <= 2.0


@pytest.mark.slow
def test_study_holds_them_for_every_law_that_has_the_parameter(
    curve_file: Path, tmp_path: Path
) -> None:
    study = ["study", curve_file, "--law", "coulomb", "--law", "coulomb+stribeck", "--workers", 1]
    study += ["--starts", 2, "-o", tmp_path / "out"]
    assert stribeck(*study, "--fix", "stribeck_exponent=1").returncode == 0
    text = (tmp_path / "out" / "fits.csv").read_text()
    assert text.count('""stribeck_exponent"": 1.0') == 2
    again = stribeck(*study)
    assert again.returncode == 2 and "with other bounds, starts or fixed values" in again.stderr
    wrong = stribeck(*study[:-1], tmp_path / "other", "--fix", "load_coulomb=1")
    assert wrong.returncode == 2 and "no model that is fitted has a parameter" in wrong.stderr
    assert not (tmp_path / "other").exists()


@pytest.mark.slow
def test_study_takes_constraints_ties_and_losses(curve_file: Path, tmp_path: Path) -> None:
    study = ["study", curve_file, "--law", "coulomb", "--law", "coulomb+stribeck", "--workers", 1]
    study += ["--starts", 2, "-o", tmp_path / "out", "--tie", "stribeck_height = 0.3*a2"]
    done = stribeck(*study, "--loss", "huber", "--constraint", "viscous_friction >= 1.25")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "out" / "fits.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["law"] == "coulomb+stribeck"]
    best = min(rows, key=lambda row: float(row["rmse"]))
    found = json.loads(best["parameters"])
    assert found["stribeck_height"] == 0.3 * found["coulomb_friction"]
    assert found["viscous_friction"] >= 1.25 - 1e-9


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--bound", "a2"], "--bound a2: write --bound NAME=LOW:HIGH"),
        (["--bound", "a2=1"], "--bound a2=1: write --bound NAME=LOW:HIGH"),
        (["--bound", "a2=a:1"], "--bound a2=a:1 is 'a': give a number"),
        (["--bound", "a2=2:1"], "the bounds of coulomb_friction are empty: 2 .. 1"),
        (["--fix", "a2=1", "--fix", "a2=2"], "a2 is given already"),
        (["--fix", "a2=1", "--fix", "coulomb_friction=2"], "is about coulomb_friction, which is"),
        (["--fix", "stribeck_height=1"], "coulomb has no parameter 'stribeck_height'"),
        (["--start", "a2=1e9"], "coulomb_friction starts at 1e+09, outside"),
    ],
)
def test_what_cannot_be_is_one_line(curve_file: Path, words: list[str], sentence: str) -> None:
    done = stribeck("fit", curve_file, "--model", "coulomb", *words)
    assert done.returncode == 2 and done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("note:")]
    assert len(lines) == 1 and sentence in lines[0], done.stderr
