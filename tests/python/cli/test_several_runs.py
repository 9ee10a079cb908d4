"""Several recordings through the real command: grammar, names, refusals."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from synthetic import joint


def stribeck(*words: object, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the command in a folder."""
    return subprocess.run(
        [sys.executable, "-m", "stribeck", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        cwd=folder,
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """run1.csv, run2.csv, logs/run3.parquet, a model m.toml, and a model under the name m.csv."""
    made = tmp_path_factory.mktemp("several")
    joint(rows=1000, seed=1).write_csv(made / "run1.csv")
    joint(rows=1000, seed=2).write_csv(made / "run2.csv")
    (made / "logs").mkdir()
    joint(rows=1000, seed=3).write_parquet(made / "logs" / "run3.parquet")
    done = stribeck("fit", "run*.csv", "--model", "coulomb", "-o", "m.toml", folder=made)
    assert done.returncode == 0, done.stderr
    (made / "m.csv").write_bytes((made / "m.toml").read_bytes())
    return made


def answer(*words: object, folder: Path) -> dict[str, object]:
    """The JSON object of a command."""
    done = stribeck(*words, "--json", folder=folder)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    assert isinstance(made, dict)
    return made


def refused(*words: object, folder: Path, said: str) -> None:
    """Exit code 2, nothing on stdout, one line that says `said`."""
    done = stribeck(*words, folder=folder)
    lines = [x for x in done.stderr.splitlines() if not x.startswith("note: ")]
    assert done.returncode == 2 and done.stdout == "" and len(lines) == 1, done.stderr
    assert lines[0].startswith("stribeck: ") and said in lines[0], lines[0]


@pytest.mark.slow
def test_files_patterns_and_folders_are_the_same(folder: Path) -> None:
    two = [
        answer("fit", *given, "--model", "coulomb", folder=folder)
        for given in (["run1.csv", "run2.csv"], ["run*.csv"], ["run1.csv", "run[2-9].csv"])
    ]
    assert [made["rmse"] for made in two] == [two[0]["rmse"]] * 3
    inspected = answer("inspect", "run1.csv", "run2.csv", "logs", folder=folder)
    assert inspected["runs"] == 3 and inspected["rows"] == 3000
    assert [row["file"] for row in inspected["files"]] == [
        "run1.csv",
        "run2.csv",
        "logs/run3.parquet",
    ]
    text = stribeck("inspect", "run*.csv", folder=folder).stdout
    assert "run1  run1.csv" in text and "run2  run2.csv" in text


@pytest.mark.slow
def test_models_among_the_data(folder: Path) -> None:
    orders = (
        ["run1.csv", "logs", "coulomb", "m.toml"],
        ["coulomb", "run1.csv", "m.toml", "logs"],
        ["run1.csv", "logs/*", "c1*v + c2*tanh(v/0.01)", "m.toml"],
    )
    made = [answer("compare", *words, folder=folder) for words in orders]
    for compared in made:
        assert compared["data"]["rows"] == 2000
        assert len(compared["models"]) == 2
    assert made[0]["models"][0]["rmse"] == made[1]["models"][0]["rmse"]


def test_both_orders_of_add(folder: Path) -> None:
    new = answer("add", "run1.csv", "run2.csv", "coulomb", "offset", folder=folder)
    old = answer("add", "coulomb", "offset", "run1.csv", "run2.csv", folder=folder)
    assert new["rmse_after"] == old["rmse_after"] and new["effect"] == "offset"


def test_diagnose_takes_several(folder: Path) -> None:
    made = answer("diagnose", "run1.csv", "logs", "m.toml", folder=folder)
    assert made["model"] == "coulomb"


@pytest.mark.slow
def test_refusals(folder: Path) -> None:
    fit = ("--model", "coulomb")
    refused("fit", "x*.csv", *fit, folder=folder, said="no file matches this pattern")
    refused("fit", "run1.csv", "run1.csv", *fit, folder=folder, said="is given twice")
    refused("fit", "run1.csv", "m.toml", *fit, folder=folder, said="one of them with --model")
    refused("compare", "run1.csv", "m.csv", folder=folder, said="name it .toml")
    refused("compare", "coulomb", folder=folder, said="no recording is among coulomb")
    refused("compare", "logs/x*", "coulomb", folder=folder, said="no file matches")
    refused("diagnose", "run1.csv", "coulomb", "dahl", folder=folder, said="one model is needed")
    refused("add", "run1.csv", "coulomb", folder=folder, said="one model and one effect")
    refused("inspect", "run1.csv", "logs", "--write-sidecar", folder=folder, said="one at a time")
    refused("improve", folder=folder, said="DATA")


@pytest.mark.slow
def test_the_error_on_another_recording(folder: Path) -> None:
    words = ["run1.csv", "--evaluate", "run2.csv", "--evaluate", "logs"]
    fitted = answer("fit", *words, "--model", "coulomb", "-o", "one.toml", folder=folder)
    rows = fitted["evaluated"]
    assert [row["file"] for row in rows] == ["run2.csv", "logs/run3.parquet"]
    # The same figures as a model file that is not refitted.
    compared = answer("compare", "run2.csv", "one.toml", folder=folder)["models"][0]
    assert rows[0]["rmse"] == compared["rmse"]
    assert rows[0]["relative_residual"] == compared["relative_residual"]
    text = stribeck("fit", *words, "--model", "coulomb", folder=folder).stdout
    assert "other recording" in text and "not fitted: run2.csv" in text
    assert "evaluated" not in answer("fit", "run1.csv", "--model", "coulomb", folder=folder)


def test_improve_with_another_recording(folder: Path) -> None:
    words = ["improve", "run1.csv", "--evaluate", "run2.csv", "--max-steps", "0"]
    made = answer(*words, folder=folder)
    assert made["evaluated"][0]["rmse"] == pytest.approx(made["final"]["rmse"], rel=0.2)


@pytest.mark.slow
def test_refused_other_recordings(folder: Path) -> None:
    fit = ("fit", "run*.csv", "--model", "coulomb", "--evaluate")
    refused(*fit, "run2.csv", folder=folder, said="run2.csv: the model is fitted to it")
    refused(*fit, "absent.csv", folder=folder, said="absent.csv: no such file")
    refused(*fit, "m.toml", folder=folder, said="m.toml: is a model file")
    refused(
        *("fit", "logs", "--stream", "--model", "coulomb", "--evaluate", "run1.csv"),
        folder=folder,
        said="--evaluate needs all samples in memory",
    )
