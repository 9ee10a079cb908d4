"""`stribeck export` and `sb.export`: what is written, what it says, what is refused."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb


def run(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "stribeck", "export", *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


@pytest.fixture
def model_file(tmp_path: Path) -> str:
    path = tmp_path / "shoulder.toml"
    sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).save(str(path))
    text = path.read_text() + "\n[box]\nvelocity = [-3.0, 3.0]\n"
    text += '\n[fitted_on]\npath = "day_1.csv"\nrows = 4000\nrmse = 0.031\n'
    path.write_text(text)
    return str(path)


def test_the_header_says_where_the_model_is_from(model_file: str, tmp_path: Path) -> None:
    done = run(model_file, "--to", "c", str(tmp_path / "out"), "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["model"] == "coulomb" and answer["passive"] is True
    names = [Path(path).name for path in answer["files"]]
    assert names == ["shoulder.h", "shoulder.c", "shoulder_vectors.h", "shoulder_test.c"]
    header = (tmp_path / "out" / "shoulder.h").read_text()
    for said in ("day_1.csv, 4000 samples", "RMSE: 0.031 N m", "Passive: yes", "velocity -3 .. 3"):
        assert said in header
    assert "double viscous_friction; /* a1 [N m s/rad]" in header


def test_the_document_holds_the_step(model_file: str, tmp_path: Path) -> None:
    assert run(model_file, "--to", "json", str(tmp_path)).returncode == 0
    document = json.loads((tmp_path / "shoulder.json").read_text())
    step = document["step"]
    names = [name for name, _, _ in step["operations"]]
    assert names[step["torque"]] == "add" and "multiply" in names and step["states"] == []
    assert [p["value"] for p in document["parameters"]] == [0.5, 2.0]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--to", "cobol"], "--to cannot be 'cobol'"),
        (["--to", "c", "--precision", "f16"], "--precision cannot be 'f16'"),
        (["--to", "rust", "--libm"], "libm is for C in floating point"),
        (["--to", "c", "--box", "velocity"], "write --box CHANNEL=LOW:HIGH"),
        (["--to", "c", "--seed", "-1"], "-1 is not in the range"),
    ],
)
def test_bad_options_end_in_one_line(
    model_file: str, tmp_path: Path, words: list[str], sentence: str
) -> None:
    done = run(model_file, *words, str(tmp_path / "out"))
    assert done.returncode == 2 and done.stdout == ""
    assert sentence in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_model_without_values_is_refused(tmp_path: Path) -> None:
    with pytest.raises(sb.SpecError, match="has no value for bristle_stiffness"):
        sb.export(sb.model("lugre"), "c", tmp_path)


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    model = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    with pytest.raises(sb.ModelFileError, match="cannot create the folder"):
        sb.export(model, "c", tmp_path / "file")


def test_a_box_without_a_finite_torque_is_refused(tmp_path: Path) -> None:
    model = sb.law("Fc*sgn(v)/(v*v)", Fc=1.0)
    with pytest.raises(sb.SpecError, match="no finite torque at velocity"):
        sb.export(model, "c", tmp_path, box={"velocity": (-1.0, 1.0)})
