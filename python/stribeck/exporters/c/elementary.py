"""Elementary functions in C that give the same bits as those of the core.

The algorithms are in ``templates/elementary.c.j2``; constants and coefficients come from the core,
so that they are stated once.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from stribeck import _core
from stribeck.exporters.c.number import Format

#: The functions that each function calls.
PARTS: dict[str, tuple[str, ...]] = {
    "infinity": ("of_bits",),
    "not_a_number": ("of_bits",),
    "is_finite": ("to_bits",),
    "abs": ("to_bits", "of_bits"),
    "copy_sign": ("to_bits", "of_bits"),
    "nearest": ("to_bits",),
    "times_power_of_two": ("of_bits",),
    "short_of": ("to_bits", "of_bits"),
    "exponent_and_significand": ("to_bits", "of_bits"),
    "exp": ("nearest", "within", "times_power_of_two", "exp_beyond"),
    "half_expm1": ("nearest", "within", "expm1_beyond", "of_bits"),
    "expm1": ("half_expm1", "abs"),
    "phi": ("expm1", "infinity"),
    "ln": ("exponent_and_significand", "log_beyond", "infinity", "not_a_number"),
    "log2_pair": ("exponent_and_significand", "short_of", "log_tail"),
    "power": (
        "log2_pair",
        "nearest",
        "within",
        "times_power_of_two",
        "exp2_series",
        "abs",
        "copy_sign",
        "infinity",
        "not_a_number",
        "short_of",
    ),
    "tanh": ("half_expm1", "within", "abs", "copy_sign"),
    "atan": ("abs", "copy_sign", "atan_series"),
    "sin": ("sin_cos",),
    "cos": ("sin_cos",),
    "sin_cos": (
        "nearest",
        "abs",
        "infinity",
        "not_a_number",
        "short_of",
        "sin_series",
        "cos_beyond",
    ),
    "sqrt": ("infinity", "not_a_number", "to_bits"),
    "cbrt": ("to_bits", "of_bits"),
}

#: Polynomials: the variable, and whether an argument ``first`` is the constant term ("first"), or
#: is added to a polynomial that has one ("gap").
POLYNOMIALS: dict[str, tuple[str, str | None]] = {
    "exp_beyond": ("r", "gap"),
    "expm1_beyond": ("r", "gap"),
    "exp2_series": ("f", None),
    "log_beyond": ("z", "first"),
    "log_tail": ("z", None),
    "atan_series": ("z", None),
    "sin_series": ("z", None),
    "cos_beyond": ("z", "gap"),
}

#: 64 zeros, the binary digits of 2/pi, and 64 more zeros that never matter.
TWO_OVER_PI = (
    "0x0000000000000000",
    "0xa2f9836e4e441529",
    "0xfc2757d1f534ddc0",
    "0xdb6295993c439041",
    "0xfe5163abdebbc561",
    "0xb7246e3a424dd2e0",
    "0x06492eea09d1921c",
    "0xfe1deb1cb129a73e",
    "0xe88235f52ebb4484",
    "0xe99c7026b45f7e41",
    "0x3991d639835339f4",
    "0x9c845f8bbdf9283b",
    "0x1ff897ffde05980f",
    "0xef2f118b5a0a6d1f",
    "0x6d367ecf27cb09b7",
    "0x4f463f669e5fea2d",
    "0x7527bac7ebe5f17b",
    "0x3d0739f78a5292ea",
    "0x6bfb5fb11f8d5d08",
    "0x56033046fc7b6bab",
    "0x0000000000000000",
)


def with_parts(functions: Iterable[str], form: Format) -> frozenset[str]:
    """The given functions and all that they call."""
    found: set[str] = set()
    wanted = list(functions)
    if "cbrt" in wanted and not form.single:
        wanted += ["abs", "copy_sign"]
    while wanted:
        name = wanted.pop()
        if name not in found:
            found.add(name)
            wanted.extend(PARTS.get(name, ()))
    return frozenset(found)


def context(functions: Iterable[str], form: Format) -> dict[str, object]:
    """The variables of the template of the elementary functions."""
    constants = _core.elementary_constants(single=form.single)
    whole = 2.0**form.stored
    one_bits = form.bias << form.stored
    root_half = _bits(math.sqrt(0.5), form)
    digits = form.stored + 1

    def constant(name: str, place: int = 0) -> str:
        return form.literal(constants[name][place])

    return {
        "used": with_parts(functions, form),
        "real": form.real,
        "word": form.word,
        "bits": form.bits,
        "stored": form.stored,
        "bias": form.bias,
        "lit": form.literal,
        "integer": form.integer,
        "hex": form.hexadecimal,
        "constant": constant,
        "polynomials": tuple(POLYNOMIALS),
        "polynomial": lambda name: polynomial(name, constants[name], form),
        "sign_bit": 1 << (form.bits - 1),
        "all_bits": (1 << form.bits) - 1,
        "fraction_mask": (1 << form.stored) - 1,
        "exponent_mask": ((1 << (form.bits - 1)) - 1) ^ ((1 << form.stored) - 1),
        "quiet_bit": 1 << (form.stored - 1),
        "lower_half": (1 << -(-digits // 2)) - 1,
        "rounder": 1.5 * whole,
        "lift": whole * whole,
        "root_of_lift": 1.0 / whole,
        "smallest_normal": 2.0 ** (1 - form.bias),
        "one_bits": one_bits,
        "root_half": root_half,
        "whole_from": whole,
        "whole_bits": _bits(whole, form),
        "normal_offset": whole + form.bias,
        "lifted_offset": whole + form.bias + 2 * form.stored,
        # The core has these fractions and bounds in single precision, in both formats.
        "three_fifths": float(np.float32(3.0) / np.float32(5.0)),
        "three_sevenths": float(np.float32(3.0) / np.float32(7.0)),
        "atan_small": float(np.float32(0.41421357)),
        "atan_large": float(np.float32(2.4142137)),
        "two_over_pi": TWO_OVER_PI,
    }


def _bits(x: float, form: Format) -> int:
    if form.single:
        return int(np.float32(x).view(np.uint32))
    return int(np.float64(x).view(np.uint64))


def polynomial(name: str, coefficients: Sequence[float], form: Format) -> str:
    """A polynomial as a C function, by Estrin's scheme with the core's order of operations.

    Examples
    --------
    >>> from stribeck.exporters.c.number import FORMATS
    >>> print(polynomial("sin_series", [1.0, 2.0, 3.0], FORMATS["f64"]))
    static double sin_series(double z)
    {
        const double z_2 = z * z;
        return (1.0 + (2.0 * z)) + (3.0 * z_2);
    }
    """
    variable, first = POLYNOMIALS[name]
    terms = [form.literal(c) for c in coefficients]
    joined: list[str] = []
    if first == "first":
        terms.insert(0, "first")
    elif first == "gap":
        joined.append("first")
    power = variable
    squares: list[str] = []
    while True:
        for k in range(0, len(terms) - 1, 2):
            joined.append(f"({terms[k]} + ({terms[k + 1]} * {power}))")
        if len(terms) % 2:
            joined.append(terms[-1])
        if len(joined) == 1:
            break
        terms, joined = joined, []
        square = f"{variable}_{2 ** (len(squares) + 1)}"
        squares.append(f"    const {form.real} {square} = {power} * {power};\n")
        power = square
    arguments = f"{form.real} first, {form.real} {variable}" if first else f"{form.real} {variable}"
    value = joined[0].removeprefix("(").removesuffix(")")
    return f"static {form.real} {name}({arguments})\n{{\n{''.join(squares)}    return {value};\n}}"
