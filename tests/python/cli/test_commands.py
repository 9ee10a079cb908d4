"""Every command of the loop: one JSON object on stdout, progress on stderr, exit code 0."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import stribeck as sb

COMMANDS = (
    "demo",
    "inspect",
    "models",
    "effects",
    "fit",
    "compare",
    "diagnose",
    "add",
    "improve",
    "generate",
)


def stribeck(*words: object) -> subprocess.CompletedProcess[str]:
    """Run the command as a user does."""
    return subprocess.run(
        [sys.executable, "-m", "stribeck", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


def answer(*words: object) -> dict[str, Any]:
    """The one JSON object that a command prints, and nothing else."""
    done = stribeck(*words, "--json")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1 and done.stdout.endswith("\n")
    assert "Traceback" not in done.stderr
    made = json.loads(done.stdout, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    assert isinstance(made, dict)
    return made


@pytest.fixture(scope="module")
def model_file(tmp_path_factory: pytest.TempPathFactory, plain_file: Path) -> Path:
    """A model file that `fit` wrote."""
    path = tmp_path_factory.mktemp("model") / "m.toml"
    done = stribeck("fit", plain_file, "--model", "coulomb", "-o", path, "--json")
    assert done.returncode == 0, done.stderr
    assert "note: " in done.stderr and f"wrote {path}" in done.stderr
    assert json.loads(done.stdout)["model"] == "coulomb"
    return path


def test_help_waits_for_no_library_that_it_does_not_use() -> None:
    slow = {"scipy.special", "scipy.optimize", "scipy.stats", "scipy.signal", "matplotlib"}
    said = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "stribeck", "--help"],
        capture_output=True,
        text=True,
        check=True,
    ).stderr
    loaded = {line.rsplit("|", 1)[-1].strip() for line in said.splitlines()}
    assert "stribeck.cli" in loaded and not loaded & slow


def test_fit(plain_file: Path) -> None:
    made = answer("fit", plain_file, "--model", "coulomb+offset")
    assert {
        "model",
        "parameters",
        "rmse",
        "rmse_held_out",
        "relative_residual",
        "starts",
        "converged",
        "evaluations",
        "seconds",
        "passive",
        "scored",
    } <= set(made)
    assert made["model"] == "coulomb+offset"
    for row in made["parameters"].values():
        assert {"symbol", "value", "unit", "stderr", "ci95", "at_bound", "identifiable"} <= set(row)
    assert made["parameters"]["coulomb_friction"]["value"] == pytest.approx(3.0, rel=0.02)
    assert made["parameters"]["viscous_friction"]["unit"] == "N m s/rad"


def test_model_file_is_readable_and_says_where_it_comes_from(
    model_file: Path, plain_file: Path
) -> None:
    stored = sb.read_model_file(model_file)
    recording = sb.read(plain_file)
    fit = sb.fit("coulomb", recording)
    assert stored.model.values.tobytes() == fit.model.values.tobytes()
    assert stored.fitted_on["sha256"] == recording.sha256
    assert stored.fitted_on["rows"] == recording.scored()["rows"]
    assert stored.fitted_on["rmse"] == fit.rmse
    assert set(stored.stderr) == set(stored.model.names)
    assert "velocity" in stored.model.box and stored.model.bounds


def test_compare(plain_file: Path, model_file: Path, tmp_path: Path) -> None:
    made = answer("compare", plain_file, "coulomb", model_file)
    assert {"data", "models", "noise_floor", "scored"} <= set(made)
    spec, stored = made["models"]
    for row in made["models"]:
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
        assert {"regime", "share", "rmse", "bias"} <= set(row["regimes"][0])
    assert spec["rmse"] == stored["rmse"]
    assert spec["rmse_held_out"] is not None and stored["rmse_held_out"] is None
    # A byte more makes it another file.
    other = tmp_path / "other.csv"
    other.write_bytes(plain_file.read_bytes() + b"\n")
    elsewhere = answer("compare", other, model_file)["models"][0]
    assert elsewhere["rmse_held_out"] == elsewhere["rmse"] == stored["rmse"]


@pytest.mark.slow
def test_diagnose(plain_file: Path, model_file: Path, tmp_path: Path) -> None:
    page, figures = tmp_path / "page.html", tmp_path / "figures"
    made = answer("diagnose", plain_file, model_file, "--report", page, "--figures", figures)
    assert "No effect that this recording can show is missing" in page.read_text()
    assert not figures.exists()
    assert {
        "model",
        "rmse",
        "rmse_held_out",
        "noise_floor",
        "verdict",
        "findings",
        "untestable",
        "unexplained",
        "scored",
    } <= set(made)
    assert made["verdict"] == "none" and made["findings"] == []
    assert set(made["unexplained"]) == {"share", "where"}


def test_add(plain_file: Path, model_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "wider.toml"
    made = answer("add", model_file, "offset", plain_file, "-o", output)
    assert {
        "model",
        "effect",
        "rmse_before",
        "rmse_after",
        "rmse_held_out_before",
        "rmse_held_out_after",
        "parameters",
    } <= set(made)
    assert made["model"] == "coulomb+offset" and made["effect"] == "offset"
    assert made["rmse_after"] <= made["rmse_before"]
    assert sb.load(output).spec == "coulomb+offset"


def test_improve(plain_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "best.toml"
    words = ("improve", plain_file, "--base", "coulomb", "-o", output)
    made = answer(*words)
    assert {
        "base",
        "noise_floor",
        "steps",
        "final",
        "stopped",
        "untestable",
        "unexplained",
        "scored",
    } <= set(made)
    assert {"model", "rmse", "rmse_held_out", "relative_residual"} <= set(made["final"])
    assert made["steps"] == [] and made["stopped"] == "noise_floor"
    assert sb.load(output).spec == made["final"]["model"]
    # A model file is as good a base as a spec.
    assert answer("improve", plain_file, "--base", output, "--max-steps", "0")["base"] == "coulomb"


def test_inspect(plain_file: Path) -> None:
    made = answer("inspect", plain_file)
    assert {
        "rows",
        "joints",
        "runs",
        "columns",
        "rate_hz",
        "gaps",
        "testable",
        "untestable",
    } <= set(made)
    assert made["rows"] == 1500
    for column in made["columns"].values():
        assert {"from", "unit", "min", "max"} <= set(column)


def test_models_and_effects() -> None:
    laws, effects = answer("models"), answer("effects")
    assert {row["id"] for row in laws["models"]} == set(sb.laws()["id"])
    for row in laws["models"]:
        assert row["source"] and row["formula"] and row["parameters"] and row["captures"]
        assert all({"name", "symbol", "unit"} <= set(p) for p in row["parameters"])
    assert {row["id"] for row in effects["effects"]} == set(sb.effects()["id"])
    for row in effects["effects"]:
        assert row["needs"] and row["what"]


def test_progress_goes_to_stderr(plain_file: Path) -> None:
    done = stribeck("improve", plain_file, "--json")
    assert "fitting coulomb" in done.stderr and "searching for" in done.stderr
    assert done.stdout.startswith("{")


@pytest.mark.slow
def test_same_seed_same_answer(plain_file: Path) -> None:
    first, second = (
        answer("fit", plain_file, "--model", "coulomb+stribeck", "--starts", "3", "--seed", "4")
        for _ in range(2)
    )
    first.pop("seconds"), second.pop("seconds")
    assert first == second


@pytest.mark.parametrize("command", COMMANDS)
def test_help(command: str) -> None:
    done = stribeck(command, "--help")
    assert done.returncode == 0 and done.stderr == ""
    assert done.stdout.startswith(f"Usage: stribeck {command}")
    for option in ("--json", "--seed", "--help"):
        assert option in done.stdout, option


def test_help_lists_the_commands() -> None:
    done = stribeck("--help")
    assert done.returncode == 0
    for command in COMMANDS:
        assert f"  {command} " in done.stdout


@pytest.mark.slow
def test_texts_for_people(plain_file: Path, model_file: Path) -> None:
    for words in (
        ("fit", plain_file, "--model", "coulomb"),
        ("compare", plain_file, "coulomb", model_file),
        ("inspect", plain_file),
        ("models",),
        ("effects",),
    ):
        done = stribeck(*words)
        assert done.returncode == 0 and len(done.stdout.splitlines()) > 2, words
        assert "Traceback" not in done.stderr and "nan" not in done.stdout.split()
