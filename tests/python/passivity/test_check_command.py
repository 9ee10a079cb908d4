"""`stribeck check`: exit codes, JSON, the box."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import stribeck as sb
from click.testing import CliRunner, Result
from stribeck.base.errors import SpecError
from stribeck.cli.flags import with_flags
from stribeck.cli.main import cli


@pytest.fixture
def lugre(tmp_path: Path) -> str:
    """A file of the 1995 example, its box up to 0.05 m/s."""
    model = sb.model("lugre", a1=1e5, a2=1e5**0.5, a3=0.4, a4=1.0, a5=1.5, a6=1e-3, a7=2.0)
    path = tmp_path / "lugre.toml"
    model.save(str(path))
    path.write_text(path.read_text() + "\n[box]\nvelocity = [-0.05, 0.05]\n")
    return str(path)


def run(*words: str) -> Result:
    """The command; errors come through."""
    return CliRunner().invoke(cli, ["check", *words], catch_exceptions=True)


def test_box_of_the_file_and_exit_code_1(lugre: str) -> None:
    result = run(lugre, "--json")
    assert result.exit_code == 1
    answer = json.loads(result.stdout)
    keys = {"model", "passive", "box", "margin", "condition", "counterexample"}
    assert keys <= set(answer)
    assert (answer["model"], answer["passive"], answer["condition"]) == ("lugre", False, "cycle")
    assert answer["box"] == {"velocity": [-0.05, 0.05]}
    assert answer["margin"] < 0.0
    example = answer["counterexample"]
    assert example["net_work_J"] < 0.0
    assert [set(step) for step in example["steps"]] == [{"velocity", "duration"}] * 2


def test_given_box_and_exit_code_0(lugre: str) -> None:
    result = run(lugre, "--box", "velocity=-0.03:0.03", "--json")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert (answer["passive"], answer["counterexample"]) == (True, None)
    assert answer["margin"] >= 0.0


def test_words(lugre: str) -> None:
    broken, proved = run(lugre), run(lugre, "--box", "velocity=-0.03:0.03")
    assert "lugre is not passive for velocity -0.05 to 0.05" in broken.stdout
    assert "Net work -" in broken.stdout
    assert "lugre is passive for velocity -0.03 to 0.03" in proved.stdout


def test_cannot_decide_is_neither(tmp_path: Path) -> None:
    model = sb.model(
        "bliman_sorine",
        coulomb_friction=1.0,
        overshoot_ratio=0.3,
        distance_ratio=0.2,
        sliding_distance=1e-3,
    )
    path = tmp_path / "model.toml"
    model.save(str(path))
    result = run(str(path), "--box", "velocity=-1:1", "--json")
    answer = json.loads(result.stdout)
    assert result.exit_code == 1
    assert (answer["passive"], answer["counterexample"]) == (None, None)
    words = run(str(path), "--box", "velocity=-1:1").stdout
    assert words.startswith("Cannot decide")
    assert "is not passive" not in words


@pytest.mark.parametrize(
    ("side", "said"),
    [
        ("velocity", "write --box CHANNEL=LOW:HIGH"),
        ("velocity=1", "write --box CHANNEL=LOW:HIGH"),
        ("velocity=a:b", "write --box CHANNEL=LOW:HIGH"),
        ("velocity=1:-1", "lower end first"),
        ("velocity=0:nan", "finite"),
        ("speed=0:1", "the box cannot have 'speed'"),
    ],
)
def test_bad_box(lugre: str, side: str, said: str) -> None:
    result = run(lugre, "--box", side, "--json")
    assert isinstance(result.exception, SpecError)
    assert said in with_flags(str(result.exception))
    assert result.stdout == ""


def test_a_side_twice(lugre: str) -> None:
    result = run(lugre, "--box", "velocity=0:1", "--box", "velocity=0:2")
    assert "given twice" in str(result.exception)
