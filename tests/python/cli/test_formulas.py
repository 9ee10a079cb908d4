"""Laws and effects by formula on the command line, and what is said about single parameters."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from as_user import answer, stribeck

LAW = "c1*v + c2*tanh(v/c3)"


@pytest.mark.slow
def test_fit_writes_a_file_that_every_command_takes(plain_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "own.toml"
    fitted = answer(
        "fit",
        plain_file,
        "--law",
        LAW,
        "--parameter",
        "c3: rad/s, 1e-4..1, start 0.01",
        "--fix",
        "c1=1.2",
        "--bound",
        "c2=0:",
        "-o",
        out,
    )
    assert fitted["model"] == "formula" and fitted["formulas"] == {"formula": LAW}
    assert fitted["parameters"]["c1"]["held"] and fitted["parameters"]["c1"]["value"] == 1.2
    assert fitted["parameters"]["c3"]["unit"] == "rad/s"
    compared = answer("compare", plain_file, out, "coulomb", "--law", "b = c1*v + c2*sgn(v)")
    assert [row["model"] for row in compared["models"]] == ["formula", "coulomb", "b"]
    assert compared["models"][2]["rmse"] == pytest.approx(compared["models"][1]["rmse"], rel=1e-9)
    wider = tmp_path / "wider.toml"
    added = answer("add", out, "creep = c*abs(load)*sgn(v)", plain_file, "-o", wider)
    assert (added["model"], added["effect"]) == ("formula+creep", "creep")
    assert sb.load(wider).value("c1") == 1.2
    assert answer("diagnose", plain_file, wider)["model"] == "formula+creep"


def test_improve_from_a_formula(plain_file: Path) -> None:
    found = answer(
        "improve", plain_file, "--law", "c1*v", "--candidate", "dry = c*sgn(v)", "--max-steps", 1
    )
    assert found["base"] == "formula"
    assert [step["effect"] for step in found["steps"]] == ["dry"]
    assert found["final"]["model"] == "formula+dry"
    assert "dry_c" not in found["steps"][0]["parameters"]
    assert "dry" in found["steps"][0]["parameters"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["fit", "{data}"], "no model is given"),
        (["fit", "{data}", "--law", "c1*v", "--model", "coulomb"], "one model is needed, 2 are"),
        (["fit", "{data}", "--law", "c1*v +"], "a value is missing at the end, at position 7"),
        (["fit", "{data}", "--law", "c1*tnah(v)"], "did you mean 'tanh'?"),
        (["fit", "{data}", "--law", "c1*v", "--start", "c1"], "write --start NAME=VALUE"),
        (["fit", "{data}", "--law", "c1*v", "--bound", "c1=3"], "write --bound NAME=LOW:HIGH"),
        (["fit", "{data}", "--law", "c1*v", "--fix", "c2=3"], "no parameter 'c2'"),
        (["fit", "{data}", "--law", "c1*v", "--fix", "c1=inf"], "give a finite number"),
        (["fit", "{data}", "--law", "c1*v", "--parameter", "c2: s"], "no formula has this"),
        (["fit", "{data}", "--model", "coulomb", "--effect", "load=c*v"], "already in the catalog"),
        (["compare", "{data}"], "no model is given"),
        (["add", "coulomb", "creep = c*laod*v", "{data}"], "did you mean 'load'?"),
        (["diagnose", "{data}", "coulomb", "--candidate", "c*v"], "is written NAME = FORMULA"),
    ],
)
def test_what_cannot_be_is_one_line(plain_file: Path, words: list[str], sentence: str) -> None:
    done = stribeck(*(word.format(data=plain_file) for word in words), "--json")
    assert done.returncode == 2 and done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("note:")]
    assert len(lines) == 1 and sentence in lines[0], done.stderr
