"""Exported C compiles without a warning and gives the bits of its test vectors."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import compile_and_run, needs, random_model, valued
from stribeck.model import effect_ids, law_ids

PRECISIONS = ("f64", "f32")

#: At higher speeds a random exponent takes single precision to infinity.
SLOW = {"velocity": (-0.9, 0.9)}

#: Their steps are hundreds of branches in a row, of which cppcheck follows every combination.
TOO_LONG_FOR_CPPCHECK = ("elastoplastic", "leuven")


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("law", ["coulomb", "bittencourt_a", "lugre", "dahl", "gms"])
def test_a_law_gives_the_bits_of_python(law: str, precision: str, tmp_path: Path) -> None:
    model = valued(sb.model(law), np.random.default_rng(1))
    written = sb.export(model, "c", tmp_path, precision=precision)
    assert compile_and_run(needs("gcc"), written.files) == 0


def test_a_changed_parameter_changes_the_torque(tmp_path: Path) -> None:
    model = valued(sb.model("lugre"), np.random.default_rng(1))
    written = sb.export(model, "c", tmp_path)
    source = tmp_path / "lugre.c"
    value = repr(float(model.values[3]))
    assert source.read_text().count(f"{value}, /* coulomb_friction */") == 1
    source.write_text(source.read_text().replace(value, repr(1.001 * float(model.values[3])), 1))
    assert compile_and_run(needs("gcc"), written.files) == 1


def test_the_platforms_functions_are_close(tmp_path: Path) -> None:
    model = valued(sb.model("bittencourt_a", constants={}), np.random.default_rng(2))
    written = sb.export(model, "c", tmp_path, libm=True)
    assert "elementary_exp" not in (tmp_path / "bittencourt_a.c").read_text()
    assert compile_and_run(needs("gcc"), written.files, "-lm") == 0


def test_a_delay_is_left_out(tmp_path: Path) -> None:
    model = sb.model(
        "coulomb+delay", coulomb_friction=2.0, viscous_friction=0.5, delay=0.003
    )  # fmt: skip
    written = sb.export(model, "c", tmp_path)
    assert "left out" in (tmp_path / "coulomb_delay.h").read_text()
    assert compile_and_run(needs("gcc"), written.files) == 0


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("law", law_ids())
def test_every_law_gives_the_bits_of_python(law: str, precision: str, tmp_path: Path) -> None:
    model = valued(sb.model(law), np.random.default_rng(3))
    written = sb.export(model, "c", tmp_path, precision=precision, box=SLOW)
    assert compile_and_run(needs("gcc"), written.files) == 0


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("effect", [e for e in effect_ids() if e != "stribeck"])
def test_every_effect_gives_the_bits_of_python(effect: str, precision: str, tmp_path: Path) -> None:
    model = valued(sb.model(f"coulomb+stribeck+{effect}"), np.random.default_rng(4))
    written = sb.export(model, "c", tmp_path, precision=precision)
    assert compile_and_run(needs("gcc"), written.files) == 0


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("seed", range(30))
def test_random_models_pass_two_compilers_and_a_checker(
    seed: int, precision: str, tmp_path: Path
) -> None:
    compilers = (needs("gcc"), needs("clang"))
    checker = needs("cppcheck")
    model = random_model(seed)
    written = sb.export(model, "c", tmp_path, precision=precision, name="joint", box=SLOW)
    for compiler in compilers:
        assert compile_and_run(compiler, written.files) == 0, model.spec
    if model.law not in TOO_LONG_FOR_CPPCHECK:
        checks = "--enable=warning,performance,portability"
        words = [checker, "--quiet", "--std=c99", checks, "--error-exitcode=1"]
        subprocess.run([*words, str(tmp_path / "joint.c")], check=True)
