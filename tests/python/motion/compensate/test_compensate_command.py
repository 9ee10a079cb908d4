"""`stribeck compensate`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli
from stribeck.models.model_file import ModelFile

COLD = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
WARM = sb.model("coulomb", coulomb_friction=1.5, viscous_friction=0.2)


def run(*words: object) -> str:
    """What the command prints."""
    done = CliRunner().invoke(cli, [str(word) for word in words], catch_exceptions=False)
    assert done.exit_code == 0
    return done.stdout


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """A model file with standard errors, and what really resists."""
    cold, warm = tmp_path / "cold.toml", tmp_path / "warm.toml"
    errors = {"coulomb_friction": 0.02, "viscous_friction": 0.01}
    ModelFile(COLD, errors).write(str(cold))
    ModelFile(WARM, errors).write(str(warm))
    return cold, warm


def test_json_has_every_motion(files: tuple[Path, Path]) -> None:
    cold, warm = files
    answer = json.loads(
        run("compensate", warm, "--with", cold, "--inertia", 0.5, "--factor", 0.6, "--json")
    )
    assert [row["compensation"] for row in answer["motions"]] == ["without", "coulomb", "coulomb"]
    assert [row["factor"] for row in answer["motions"]] == [0.0, 0.6, 0.6]
    rmse = [row["rmse"] for row in answer["motions"]]
    # 0.6 times the cold friction is 0.8 times the warm Coulomb friction: nearer than 0.6 times it.
    assert rmse[0] > rmse[2] > rmse[1]


def test_the_largest_factor_is_proved_and_used(files: tuple[Path, Path]) -> None:
    cold, warm = files
    answer = json.loads(
        run(
            "compensate",
            cold,
            "--plant",
            warm,
            "--inertia",
            0.5,
            "--factor",
            "largest",
            "--box",
            "velocity=-1:1",
            "--json",
        )
    )
    (factor,) = answer["factors"]
    least = (1.5 + 0.2 - 1.96 * (0.02 + 0.01)) / 2.5
    assert factor["factor"] == pytest.approx(least, rel=5e-3)
    assert answer["motions"][1]["factor"] == factor["factor"]


def test_table_and_picture(files: tuple[Path, Path], tmp_path: Path) -> None:
    picture = tmp_path / "errors.png"
    table = run(
        "compensate",
        files[0],
        "--inertia",
        0.5,
        "--feedforward",
        "--observer",
        5,
        "--plot",
        picture,
    )
    assert "without" in table
    assert "desired" in table
    assert "observer of 5 Hz" in table
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_hand_needs_less_with_compensation(files: tuple[Path, Path]) -> None:
    words = ("compensate", files[0], "--inertia", 0.5, "--guided", "--factor", 0.85)
    without, much = json.loads(run(*words, "--json"))["motions"]
    # To break loose it has to pull as before: a law without a memory gives nothing at rest.
    assert much["interaction_rms"] < 0.5 * without["interaction_rms"]
    assert much["interaction_largest"] > 0.85 * 2.0
    assert "overcompensated" in run(*words)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--factor", "most"), "give a number from 0 to 1, or largest"),
        (("--factor", "2"), "give 0 to 1"),
        (("--box", "velocity=-1:1"), "only with --factor largest"),
        (("--kp", "1", "--ki", "1"), "must exceed 2 KI"),
        (("--observer", "0"), "bandwidth is 0 Hz"),
        (("--guided", "--observer", "5"), "--observer has no effect with --guided"),
        (("--guided", "--feedforward"), "use feedback"),
        (("--seconds", "1e12"), "steps: give 1 to"),
        (("--encoder", "-1"), "resolution of the encoder is -1"),
    ],
)
def test_bad_input_is_one_sentence(
    files: tuple[Path, Path], words: tuple[str, ...], sentence: str
) -> None:
    with pytest.raises(SpecError, match=sentence) as refused:
        CliRunner().invoke(
            cli,
            ["compensate", str(files[0]), "--inertia", "0.5", *words],
            catch_exceptions=False,
            standalone_mode=False,
        )
    assert "\n" not in str(refused.value)
