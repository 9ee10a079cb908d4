"""Exported C compiles without a warning and gives the bits of its test vectors."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import FLAGS, compile_and_run, needs, random_model, valued
from stribeck.exporters.program import Program
from stribeck.models.catalog import effect_ids, law_ids

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
    model = sb.model("coulomb+delay", coulomb_friction=2.0, viscous_friction=0.5, delay=0.003)
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


@pytest.mark.slow
@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("law", ["bittencourt_a", "lugre", "tadese_full", "gms"])
def test_a_minute_at_4_khz_has_the_bits_of_python(law: str, precision: str, tmp_path: Path) -> None:
    form = np.float32 if precision == "f32" else np.float64
    real = "float" if precision == "f32" else "double"
    model = valued(sb.model(law), np.random.default_rng(8))
    sb.export(model, "c", tmp_path, precision=precision, name="joint")
    time = np.arange(240_000) / 4000.0
    channels = {
        "velocity": 0.8 * np.sin(2.1 * time) * np.sin(0.13 * time),
        "temperature": 25.0 + 0.2 * time,
        "load_torque": 5.0 * np.cos(0.7 * time),
    }
    channels = {c: x.astype(form) for c, x in channels.items() if c in model.core.needs}
    prototype = f"void run(const joint_sample *samples, {real} *torque, unsigned int count)"
    (tmp_path / "run.c").write_text(
        f'#include "joint.c"\n{prototype};\n{prototype}\n{{\n'
        "    joint_state state;\n    joint_init(&state);\n"
        "    for (unsigned int i = 0U; i < count; i++) {\n"
        f"        torque[i] = joint_step(&joint_fitted, &state, &samples[i], ({real})0.00025);\n"
        "    }\n}\n"
    )
    library = tmp_path / "run.so"
    words = [needs("gcc"), *FLAGS, "-shared", "-fPIC", str(tmp_path / "run.c"), "-o", str(library)]
    subprocess.run(words, check=True)
    order = [c for c in Program.of(model).channels if c in channels]
    samples = np.ascontiguousarray(np.stack([channels[c] for c in order], axis=1))
    torque = np.empty(time.size, dtype=form)
    pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (samples, torque))
    ctypes.CDLL(str(library)).run(*pointers, ctypes.c_uint(time.size))
    single = precision == "f32"
    given = {c: x.astype(float) for c, x in channels.items()}
    dt = float(form(0.00025))
    expected = model.torque(**given, dt=dt, precision="single" if single else "double")
    assert np.array_equal(torque.astype(float), expected)
