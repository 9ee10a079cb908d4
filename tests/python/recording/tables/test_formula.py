"""Formulas compute over columns and can do nothing else."""

from __future__ import annotations

import math

import numpy as np
import polars as pl
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from stribeck import _core
from stribeck.base.errors import RecordingError
from stribeck.recording.tables.formula import compile_formula

TABLE = pl.DataFrame(
    {
        "a": [1, 4, 9],
        "b": [2.0, -3.0, 0.5],
        "name": ["x", "y", "x"],
        "on": [True, False, True],
        "i A": [1.0, 2.0, 3.0],
        "größe": [2, 1, 2],
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
        ("-a ^ 2 + 2 ** -1", [-0.5, -15.5, -80.5]),
        ("pow(a, 0.5) - ln(exp(a)) + [a - a]", [0.0, -2.0, -6.0]),
        ("expm1(0*a) + cbrt(a*0 + 8) + arctan(0*a) + log10(0*a + 100) + tanh(0*a)", [4.0] * 3),
        ("1_000 + 0x10 + 0*a", [1016.0] * 3),
        ("not a == 1 == True", [False, True, True]),
        ('name == "x" and True', [True, False, True]),
        ("name != 'it\\'s'", [True] * 3),
        ("größe > 1", [True, False, True]),
        ("row/100 + 0*a", [0.0, 0.01, 0.02]),
    ],
)
def test_values(text, expected):
    assert run(text) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("__import__('os').system('true')", "at position 1"),
        ("a.real", "'.real' is not a number, at position 2"),
        ("(lambda: 1)()", "':' is not allowed in a formula, at position 8"),
        ("[x for x in a]", "an operator is missing before 'for' at position 4"),
        ("open('f')", "'open' is not a function, at position 1"),
        ("coss(a)", r"'coss' is not a function \(did you mean 'cos'\?\), at position 1"),
        ("a if on else b", "an operator is missing before 'if' at position 3"),
        ("f'{a}'", "an operator is missing before"),
        ("(a := 3)", "':' is not allowed in a formula, at position 4"),
        ("a[0]", "'a' is not a function"),
        ("a in (1, 2)", "an operator is missing before 'in' at position 3"),
        ("(a, b) > 1", "an operator is missing before ',' at position 3"),
        ("a > not on", "a value is missing before 'not' at position 5"),
        ("a & on", r"'&' is not an operator \(write 'and'\), at position 3"),
        ("name == 'x", "the quote ' is never closed, at position 9"),
        ("2*vel", "unknown column 'vel'.*position 3"),
        ("2*nam", r"unknown column 'nam'; did you mean 'name'\?"),
        ("a = 2", r"'=' is not an operator \(write '=='\), at position 3 of 'a = 2'"),
        ("a +", "a value is missing at the end, at position 4"),
        ("name * 2", "text is used as a number at position 1"),
        ("a == 'x'", "text is compared with a number"),
        ("sqrt(a, b)", "sqrt takes 1 argument, not 2, at position 1"),
        ("max(a)", "max takes 2 or more arguments, not 1"),
        ("abs(x=a)", "'=' is not an operator"),
        ("", "is empty"),
        ("(" * 500 + "a" + ")" * 500, "at most 100 nested brackets"),
        ("-" * 1990 + "a", "at most 100 nested brackets"),
        ("9" * 400 + "*a", "not a finite number"),
        ("a\x00b", "is not allowed in a formula, at position 2"),
        ("1" + "+1" * 1500, "longer than 2000"),
    ],
)
def test_refused(text, sentence):
    with pytest.raises(RecordingError, match=sentence):
        run(text)


#: Channels of a law that are columns of a table, both away from zero.
CHANNELS = {
    "v": [0.3, -1.2, 2.5],
    "q": [1.1, -0.4, 3.0],
    "a": [-2.0, 0.7, 0.1],
    "T": [31.0, 20.0, 45.5],
}
_NUMBERS = st.sampled_from(["1", "2", "0.5", ".25", "3.", "1e-2", "7"])
_LEAVES = st.one_of(_NUMBERS, st.sampled_from([*CHANNELS, "pi"]))
_FUNCTIONS = sorted(name for name, _ in _core.formula_functions())


def _grown(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Formulas made of smaller ones."""
    several = {"min": 3, "max": 2, "pow": 2, "power": 2}
    calls = st.sampled_from(_FUNCTIONS).flatmap(
        lambda name: st.lists(
            inner, min_size=several.get(name, 1), max_size=several.get(name, 1)
        ).map(lambda arguments: f"{name}({', '.join(arguments)})")
    )
    signs = st.sampled_from(["-{}", "+{}", "({})", "[{}]"])
    operators = st.sampled_from(["{}+{}", "{} - {}", "{}*{}", "{}/{}", "{}^{}", "{} ** {}"])
    return st.one_of(
        calls,
        st.builds(str.format, signs, inner),
        st.builds(str.format, operators, inner, inner),
    )


@settings(deadline=None, max_examples=200, derandomize=True)
@given(st.recursive(_LEAVES, _grown, max_leaves=8))
def test_a_formula_means_the_same_in_a_law(text: str) -> None:
    """What a law accepts, columns accept, and the numbers agree to rounding.

    Where a change of the columns in the last digits changes the number, as in ``sin(T^T)``,
    rounding decides, and nothing is compared.
    """
    table = pl.DataFrame(CHANNELS)
    formula = compile_formula(text, table.schema, "t.csv: f")
    found = table.select(pl.lit(0.0) * pl.col("v") + formula.expression).to_series().to_numpy()
    try:
        law = _core.Model(None, [], {}, [(f"c + c*({text})", ["c"])])
    except _core.ModelError as error:
        # A law refuses constants that are not finite, and what is too long.
        assume("not a finite number" not in str(error) and "too long" not in str(error))
        raise
    columns = [np.array(CHANNELS[name]) for name in ("v", "q", "a", "T")]
    expected, moved = (
        law.torque(np.array([1.0]), None, *(column * factor for column in columns)) - 1.0
        for factor in (1.0, 1.0 + 1e-12)
    )
    finite = np.isfinite(found) & np.isfinite(expected) & (np.abs(expected) < 1e6)
    steady = finite & np.isclose(moved, expected, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(found[steady], expected[steady], rtol=1e-6, atol=1e-6)


def test_every_function_of_a_law_is_known() -> None:
    """Each function of the crate, under each of its names, works on columns."""
    several = {"pow", "power", "min", "max"}
    for name in _FUNCTIONS:
        assert run(f"{name}(a, b)" if name in several else f"{name}(a)")
