"""Formulas compute over columns and can do nothing else."""

from __future__ import annotations

import math

import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.formula import compile_formula

TABLE = pl.DataFrame(
    {
        "a": [1, 4, 9],
        "b": [2.0, -3.0, 0.5],
        "name": ["x", "y", "x"],
        "on": [True, False, True],
        "i A": [1.0, 2.0, 3.0],
    }
)


def run(text: str) -> list:
    formula = compile_formula(text, TABLE.schema, "t.csv: f")
    return TABLE.select(formula.expression.alias("f"))["f"].to_list()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a/1000*b", [0.002, -0.012, 0.0045]),
        ("-a + b - 1", [-0.0, -8.0, -9.5]),
        ("a**2", [1.0, 16.0, 81.0]),
        ("sqrt(a)", [1.0, 2.0, 3.0]),
        ("abs(b) + sign(b)", [3.0, 2.0, 1.5]),
        ("min(a, b, 0)", [0.0, -3.0, 0.0]),
        ("max(a, b)", [2.0, 4.0, 9.0]),
        ("sin(0*a) + cos(0*a) + exp(0*a) + log(1 + 0*a) + tan(0*a)", [2.0] * 3),
        ("a*pi", [math.pi, 4 * math.pi, 9 * math.pi]),
        ("`i A` * 2", [2.0, 4.0, 6.0]),
        ("name == 'x'", [True, False, True]),
        ("name != 'x' or a > 5", [False, True, True]),
        ("on and not (a == 1)", [False, False, True]),
        ("1 < a <= 9", [False, True, True]),
        ("on * a", [1.0, 0.0, 9.0]),
    ],
)  # fmt: skip
def test_values(text, expected):
    assert run(text) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("__import__('os').system('true')", "at position 1"),
        ("a.real", "at position 1"),
        ("(lambda: 1)()", "is not a function"),
        ("[x for x in a]", "are available"),
        ("open('f')", "'open' is not a function here"),
        ("a if on else b", "are available"),
        ("f'{a}'", "are available"),
        ("(a := 3)", "are available"),
        ("a[0]", "are available"),
        ("a in (1, 2)", "'in' and 'is' are not available|are available"),
        ("2*vel", "unknown column 'vel'.*position 3"),
        ("2*nam", r"unknown column 'nam'; did you mean 'name'\?"),
        ("a ^ 2", r"a power is written \*\*"),
        ("a = 2", "equality is written =="),
        ("a +", "is not a formula, at position"),
        ("name * 2", "text is used as a number at position 1"),
        ("a == 'x'", "text is compared with a number"),
        ("sqrt(a, b)", "sqrt takes one value"),
        ("max(a)", "takes two or more"),
        ("abs(x=a)", "plain arguments only"),
        ("", "is empty"),
        ("(" * 500 + "a" + ")" * 500, "is not a formula"),
        ("-" * 1990 + "a", "formula"),
        ("9" * 400 + "*a", "too large|not a formula"),
        ("a\x00b", "is not a formula"),
        ("1" + "+1" * 1500, "longer than 2000"),
    ],
)  # fmt: skip
def test_refused(text, sentence):
    with pytest.raises(RecordingError, match=sentence):
        run(text)
