"""Exports in fixed point stay within the error bound that they state, over all of their box."""

from __future__ import annotations

import ctypes
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import FLAGS, compile_and_run, needs, valued

BOX = {
    "velocity": (-2.0, 2.0),
    "position": (-3.0, 3.0),
    "temperature": (20.0, 50.0),
    "load_torque": (-10.0, 10.0),
}

SPECS = [
    ("coulomb", "q31"),
    ("bittencourt_a", "q31"),
    ("dong", "q31"),
    ("makkar", "q31"),
    ("bittencourt_b", "q31"),
    ("grotjahn_a", "q31"),
    ("coulomb+stribeck+gravity+offset", "q31"),
    ("coulomb+temperature_viscous", "q31"),
    ("coulomb", "q15"),
    ("dong", "q15"),
    ("hao_a", "q15"),
    ("grotjahn_b", "q15"),
]

SWEPT = 100_000


def box_of(model: sb.Model) -> dict[str, tuple[float, float]]:
    return {name: side for name, side in BOX.items() if name in model.core.needs}


def worst_error(model: sb.Model, header: Path, bits: int, seed: int) -> tuple[float, float]:
    """The largest error over the box, its corners and the neighbourhood of rest; the bound."""
    text = header.read_text()
    name = header.stem
    digits = {
        k.lower(): int(d)
        for k, d in re.findall(rf"#define {name.upper()}_(\w+)_DIGITS (-?\d+)", text)
    }
    bound = float(re.search(r"at most (\S+) N m", text)[1])
    channels = re.findall(r"int\d+_t (\w+); /\*", text)
    rng = np.random.default_rng(seed)
    whole = np.int32 if bits == 32 else np.int16
    columns = []
    for channel in channels:
        low, high = (int(np.trunc(np.ldexp(x, digits[channel]))) for x in BOX[channel])
        column = rng.integers(low, high, SWEPT, endpoint=True)
        column[: SWEPT // 8] = rng.choice([low, high, 0 if low < 0 else low], SWEPT // 8)
        column[SWEPT // 8 : SWEPT // 2] //= 2 ** rng.integers(0, bits - 3, SWEPT // 2 - SWEPT // 8)
        columns.append(np.clip(column, low, high))
    samples = np.ascontiguousarray(np.stack(columns, axis=1).astype(whole))
    sweep = (
        f'#include "{name}.c"\nvoid sweep(const {name}_sample *s, int{bits}_t *out, uint32_t n);\n'
        f"void sweep(const {name}_sample *s, int{bits}_t *out, uint32_t n)\n"
        f"{{ for (uint32_t i = 0U; i < n; i++) {{ out[i] = {name}_torque(&s[i]); }} }}\n"
    )
    source = header.with_name("sweep.c")
    source.write_text(sweep)
    library = header.with_name("sweep.so")
    command = [needs("gcc"), *FLAGS, "-fsanitize=undefined", "-fno-sanitize-recover", "-shared"]
    subprocess.run([*command, "-fPIC", str(source), "-o", str(library)], check=True)
    torque = np.empty(SWEPT, dtype=whole)
    pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (samples, torque))
    ctypes.CDLL(str(library)).sweep(*pointers, ctypes.c_uint32(SWEPT))
    exact = {c: np.ldexp(samples[:, k].astype(float), -digits[c]) for k, c in enumerate(channels)}
    expected = model.torque(**exact)
    return float(np.abs(np.ldexp(torque.astype(float), -digits["torque"]) - expected).max()), bound


@pytest.mark.parametrize(("spec", "precision"), SPECS)
def test_the_error_stays_within_its_bound(spec: str, precision: str, tmp_path: Path) -> None:
    model = valued(sb.model(spec), np.random.default_rng(5))
    written = sb.export(model, "c", tmp_path, precision=precision, name="joint", box=box_of(model))
    assert compile_and_run(needs("gcc"), written.files) == 0
    bits = 32 if precision == "q31" else 16
    worst, bound = worst_error(model, tmp_path / "joint.h", bits, seed=6)
    # The header rounds the bound to three digits.
    assert worst <= 1.005 * bound
    assert worst > 0.0


@pytest.mark.parametrize(
    ("spec", "why"),
    [
        ("lugre", "it has a memory"),
        ("iskandar", "one of its exponents varies"),
        ("bam_m6", "one of its choices depends on a rounded number"),
    ],
)
def test_what_has_no_bound_is_refused(spec: str, why: str, tmp_path: Path) -> None:
    model = valued(sb.model(spec), np.random.default_rng(7))
    box = {
        name: (20.0, 30.0) if name == "temperature" else (-1.0, 1.0) for name in model.core.needs
    }
    with pytest.raises(sb.SpecError, match=f"cannot be exported in fixed point: {why}"):
        sb.export(model, "c", tmp_path, precision="q31", box=box)


@pytest.mark.parametrize("precision", ["q31", "q15"])
def test_terms_far_below_the_digits_vanish(precision: str, tmp_path: Path) -> None:
    """The powers of two between them exceed the numbers of the controller."""
    model = sb.model("coulomb", coulomb_friction=1e25, viscous_friction=0.5)
    written = sb.export(
        model, "c", tmp_path, precision=precision, name="joint", box={"velocity": (-2.0, 2.0)}
    )
    assert compile_and_run(needs("gcc"), written.files) == 0
    worst, bound = worst_error(
        model, tmp_path / "joint.h", 32 if precision == "q31" else 16, seed=6
    )
    assert 0.0 < worst <= 1.005 * bound < 1e22


def test_fixed_point_needs_a_box_and_c(tmp_path: Path) -> None:
    model = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    with pytest.raises(sb.SpecError, match="the box of coulomb has no velocity"):
        sb.export(model, "c", tmp_path, precision="q31")
    with pytest.raises(sb.SpecError, match="q15 is for C only"):
        sb.export(model, "rust", tmp_path, precision="q15", box={"velocity": (-1.0, 1.0)})
