"""Elementary functions in C have the bits of the core's."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest
from exported_models import FLAGS, needs
from numpy.typing import NDArray
from stribeck import _core
from stribeck.exporters.c import elementary
from stribeck.exporters.c.number import FORMATS
from stribeck.exporters.precision import Precision
from stribeck.exporters.templates import template

ONE = ("exp", "expm1", "phi", "ln", "sqrt", "cbrt", "sin", "cos", "tanh", "atan")
FEW, MANY = 40_000, 4_000_000

_WRAPPER = """
void map_{name}(const {real} *x, const {real} *y, {real} *out, uint64_t count)
{{
    for (uint64_t i = 0U; i < count; i++) {{
        (void)y;
        out[i] = elementary_{name}({arguments});
    }}
}}
"""


def library(precision: Precision, folder: Path) -> ctypes.CDLL:
    """All elementary functions over arrays."""
    form = FORMATS[precision]
    head = "#include <stdbool.h>\n#include <stdint.h>\n#include <string.h>\n"
    text = head + template("c", "elementary.c.j2").render(elementary.context([*ONE, "power"], form))
    for name in (*ONE, "power"):
        arguments = "x[i], y[i]" if name == "power" else "x[i]"
        prototype = f"void map_{name}(const {form.real} *x, const {form.real} *y, "
        text += f"{prototype}{form.real} *out, uint64_t count);\n"
        text += _WRAPPER.format(name=name, real=form.real, arguments=arguments)
    source = folder / f"elementary_{precision}.c"
    source.write_text(text)
    built = folder / f"elementary_{precision}.so"
    command = [needs("gcc"), *FLAGS, "-shared", "-fPIC", str(source), "-o", str(built)]
    subprocess.run(command, check=True)
    return ctypes.CDLL(str(built))


def arguments(precision: Precision, count: int, seed: int) -> NDArray[np.floating]:
    """Any bits, numbers of usual size, and those at the ends of the format."""
    rng = np.random.default_rng(seed)
    real, word = (np.float32, np.uint32) if precision == "f32" else (np.float64, np.uint64)
    any_bits = rng.integers(0, 2 ** (8 * real(0).itemsize), count // 2, dtype=word).view(real)
    usual = (rng.standard_normal(count // 4) * 10.0 ** rng.uniform(-8, 3, count // 4)).astype(real)
    large = rng.uniform(-1.0, 1.0, count // 4) * 10.0 ** rng.uniform(3, 30, count // 4)
    tiny = np.finfo(real).smallest_subnormal
    ends = [0.0, -0.0, 1.0, -1.0, 2.0, np.inf, -np.inf, np.nan, tiny, -tiny, np.finfo(real).max]
    found = np.concatenate([any_bits, usual, large.astype(real), np.array(ends, dtype=real)])
    # On the way to the core a signalling NaN becomes a quiet one.
    found[np.isnan(found)] = np.nan
    return found


def compare(precision: Precision, count: int, folder: Path) -> None:
    """Every function over the same arguments, bit by bit; one NaN is as good as another."""
    functions = library(precision, folder)
    x = arguments(precision, count, 1)
    y = np.random.default_rng(2).permutation(arguments(precision, count, 3))
    y[::3] = np.rint(np.nan_to_num(y[::3]))
    y[::50] = 2.0
    for name in (*ONE, "power"):
        out = np.empty_like(x)
        pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (x, y, out))
        getattr(functions, f"map_{name}")(*pointers, ctypes.c_uint64(x.size))
        single = precision == "f32"
        known = _core.elementary(name, x.astype(float), y.astype(float), single=single)
        expected = np.array(known).astype(x.dtype)
        word = np.uint32 if single else np.uint64
        same = (out.view(word) == expected.view(word)) | (np.isnan(out) & np.isnan(expected))
        wrong = np.flatnonzero(~same)[:3]
        assert same.all(), f"{name} at {x[wrong]}, {y[wrong]}: {out[wrong]}, not {expected[wrong]}"


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_elementary_functions_have_the_same_bits(precision: Precision, tmp_path: Path) -> None:
    compare(precision, FEW, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_millions_of_arguments_have_the_same_bits(precision: Precision, tmp_path: Path) -> None:
    compare(precision, MANY, tmp_path)
