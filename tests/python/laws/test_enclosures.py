"""The bounds that a proof of passivity rests on, against values at 50 digits.

Over a box of a single point a bound is apart from the exact value by the allowance for rounding
alone: the harshest test of that allowance. The errors of the elementary functions, which it is
derived from (`src/passivity/enclosure.rs`), are measured at random arguments.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import stribeck as sb
from mpmath import mp, mpf
from stribeck import _core
from stribeck.models.catalog import catalog

from laws.dual import Beyond
from laws.points import LETTERS, Point, generator, random_points, special_points
from laws.reference import STATIC, evaluate
from laws.test_static import STATIC_LAWS

#: Laws on which intervals prove nothing, and says so.
BRANCHING = {"bam_m6"}
#: Smaller values of a channel count as zero in a proof.
SMALLEST = 1e-30
#: The errors in units of the last place that the allowance in `enclosure.rs` is four times of.
MOST_UNITS = 2.0


def margin(point: Point, ends: dict[str, tuple[float, float]]) -> dict[str, float]:
    model = point.model
    sides = {name: ends[name] for name in ["velocity", *catalog()["laws"][point.law]["channels"]]}
    answer = _core.passivity(model.core, model.values, sides, 2000)
    return answer["margins"][0]


def usable(points: Iterator[Point]) -> Iterator[tuple[Point, mpf]]:
    """Points with motion, and friction along it at 50 digits."""
    for point in points:
        tiny = any(0.0 < abs(x) < SMALLEST for x in point.inputs.values())
        if tiny or point.inputs["v"] == 0.0:
            continue
        try:
            exact = evaluate(STATIC[point.law], *point.exact)
        except Beyond:
            continue
        if exact.size < 1e300:
            yield point, exact.value * mp.sign(point.inputs["v"])


@pytest.mark.parametrize("law", sorted(set(STATIC_LAWS) - BRANCHING))
def test_bounds_at_a_point_contain_the_value_at_50_digits(law: str) -> None:
    judged = 0
    for points in (random_points(law, 150), special_points(law, stride=7)):
        for point, exact in usable(points):
            here = {name: (point.inputs[at], point.inputs[at]) for name, at in LETTERS.items()}
            try:
                found = margin(point, here)
            except _core.ModelError:
                continue  # The pole of a law.
            assert found["lower"] <= exact, point
            assert found["upper"] is None or exact <= found["upper"], point
            judged += 1
    assert judged >= 100


@pytest.mark.parametrize("law", sorted(set(STATIC_LAWS) - BRANCHING))
def test_bounds_over_a_box_contain_the_values_in_it(law: str) -> None:
    """Boxes across zero, from a point to twice its opposite."""
    judged = 0
    for point, exact in usable(random_points(law, 40)):
        box = {n: tuple(sorted((point.inputs[at], -2.0 * point.inputs[at])))
               for n, at in LETTERS.items()}  # fmt: skip
        try:
            assert margin(point, box)["lower"] <= exact, point
        except _core.ModelError:
            continue
        judged += 1
    assert judged >= 10 or catalog()["laws"][law]["pole"] is not None


FUNCTIONS: dict[str, tuple[Callable[..., mpf], float, float]] = {
    "exp": (mp.exp, -740.0, 709.0),
    "expm1": (mp.expm1, -40.0, 709.0),
    "ln": (mp.log, 0.0, 1e3),
    "sqrt": (mp.sqrt, 0.0, 1e9),
    "cbrt": (mp.cbrt, 0.0, 1e9),
    "sin": (mp.sin, -1e4, 1e4),
    "cos": (mp.cos, -1e4, 1e4),
    "tanh": (mp.tanh, -20.0, 20.0),
    "atan": (mp.atan, -1e4, 1e4),
}


def units(found: float, exact: mpf) -> float:
    """The error in units of the last place; those of subnormal numbers are all as large."""
    return float(abs(mpf(found) - exact) / mpf(float(np.spacing(abs(float(exact))))))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_errors_of_the_elementary_functions(name: str) -> None:
    function, low, high = FUNCTIONS[name]
    rng = generator(name, "units")
    small = rng.uniform(low, high, 500) * 10.0 ** -rng.uniform(0.0, 30.0, 500)
    x = np.concatenate([rng.uniform(low, high, 1000), small])
    x = np.abs(x) if low == 0.0 else x
    with mp.workdps(60):
        errors = [
            units(found, function(mpf(float(at))))
            for at, found in zip(x, _core.elementary(name, x.tolist()), strict=True)
        ]
    assert max(errors) <= MOST_UNITS


def test_errors_of_powers() -> None:
    """Bases and exponents whose powers fill the range, down to the smallest subnormal numbers."""
    rng = generator("power", "units")
    base = np.concatenate([rng.uniform(0.0, 20.0, 1000), 10.0 ** rng.uniform(-300, 300, 1000)])
    exponent = rng.uniform(-744.0, 709.0, 2000) / np.log(base)
    with mp.workdps(60):
        errors = [
            units(found, mpf(float(b)) ** mpf(float(p)))
            for b, p, found in zip(
                base,
                exponent,
                _core.elementary("power", base.tolist(), exponent.tolist()),
                strict=True,
            )
        ]
    assert max(errors) <= MOST_UNITS


@pytest.mark.parametrize(
    "side",
    [(1.0, -1.0), (float("nan"), 1.0), (0.0, float("inf")), (-float("inf"), 0.0), (0.0, 0.0)],
)
def test_what_is_no_interval_proves_nothing(side: tuple[float, float]) -> None:
    """Friction here generates energy at every speed; an empty box would prove it passive."""
    drives = sb.model("coulomb", viscous_friction=-5.0, coulomb_friction=-2.0)
    with pytest.raises(_core.ModelError, match=r"not two finite numbers|no motion"):
        _core.passivity(drives.core, drives.values, {"velocity": side}, 1000)
    with pytest.raises(sb.StribeckError):
        sb.check(drives, {"velocity": side})
