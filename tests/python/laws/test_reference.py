"""The reference itself: derivatives against mpmath's own, and equations worked by hand."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from mpmath import mp, mpf

from laws import dual
from laws.dual import Dual, variable
from laws.reference import STATIC, evaluate, gradient_size

FUNCTIONS: dict[str, tuple[Callable[[Dual], Dual], Callable[[mpf], mpf]]] = {
    "exp": (dual.exp, mp.exp),
    "log": (lambda x: dual.log(x * x), lambda x: mp.log(x * x)),
    "sqrt": (lambda x: dual.sqrt(x * x + 1), lambda x: mp.sqrt(x * x + 1)),
    "atan": (dual.atan, mp.atan),
    "tanh": (dual.tanh, mp.tanh),
    "sigmoid": (dual.sigmoid, lambda x: 1 / (1 + mp.exp(-x))),
    "cbrt": (dual.cbrt, lambda x: mp.sign(x) * mp.cbrt(abs(x))),
    "inverse": (dual.inverse, lambda x: 1 / x),
    "power": (
        lambda x: dual.power(dual.magnitude(x), x + 3),
        lambda x: abs(x) ** (x + 3),
    ),
    "product": (lambda x: x * x * (2 - x) / (x + 9), lambda x: x * x * (2 - x) / (x + 9)),
}


@pytest.mark.parametrize("name", list(FUNCTIONS))
@pytest.mark.parametrize("at", ["-2.3", "-0.07", "0.4", "5"])
def test_derivatives(name: str, at: str) -> None:
    carried, plain = FUNCTIONS[name]
    y = carried(variable("x", at))
    assert mp.almosteq(y.value, plain(mpf(at)), rel_eps=mpf(10) ** -45)
    with mp.workdps(80):
        slope = mp.diff(plain, mpf(at))
    assert mp.almosteq(y.slope["x"], slope, rel_eps=mpf(10) ** -20)


def test_size_of_a_sum_and_of_its_derivatives() -> None:
    """bittencourt_a by hand at v = a3: terms a1, a2/e, a5 v; df/da2 = 1/e ..."""
    parameters = {"a1": mpf(2), "a2": mpf(3), "a3": mpf("0.5"), "a4": mpf(1), "a5": mpf(4)}
    at = evaluate(STATIC["bittencourt_a"], parameters, {"v": mpf("0.5")})
    e = mp.exp(-1)
    assert mp.almosteq(at.value, 2 + 3 * e + 2)
    assert mp.almosteq(at.gradient["a2"], e)
    assert mp.almosteq(at.gradient["a3"], 3 * e / mpf("0.5"))
    assert at.gradient["a4"] == 0
    slope_of_v = -3 * e / mpf("0.5") + 4
    inner = 2 + 3 * e + 3 * e + 0 + 2 + abs(mpf("0.5") * slope_of_v)
    assert mp.almosteq(at.size, (2 + 3 * e + 2) + inner)
    size = gradient_size(STATIC["bittencourt_a"], parameters, {"v": mpf("0.5")})
    assert mp.almosteq(size["a1"], 1)
    assert mp.almosteq(size["a2"], e + e + 0 + e, rel_eps=mpf(10) ** -15)


def test_an_infinite_term_is_told() -> None:
    """madsen at T = T0."""
    parameters = {f"a{k}": mpf(1) for k in range(1, 9)}
    inputs = {"v": mpf(1), "T": mpf(20), "base_temperature": mpf(20)}
    with pytest.raises(dual.Beyond):
        evaluate(STATIC["madsen"], parameters, inputs)
