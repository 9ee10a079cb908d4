"""Static laws against their reference: value, gradient, and nothing but finite numbers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest
import stribeck as sb
from stribeck.models.catalog import catalog, law_ids

from laws.dual import Beyond
from laws.points import Point, random_points, special_points
from laws.reference import PRINTED, STATIC, evaluate, gradient_size

STATIC_LAWS = [law for law in law_ids() if not sb.model(law).has_state]

#: Error allowed in double precision (1.1e-16), in single (6e-8), and of the gradient, in
#: multiples of `Evaluated.size` and `gradient_size`.
DOUBLE, SINGLE, GRADIENT = 1e-13, 2e-6, 1e-10
#: Below these a number has fewer digits or none.
SMALLEST = {"double": 1e-290, "single": 1e-30}
#: Beyond these a number of the type overflows.
LARGEST = {"double": 1e300, "single": 1e37}


def error_of_value(point: Point, precision: str) -> float | None:
    """The error in multiples of what is allowed; None where the exact value is beyond the type."""
    given = point.rounded if precision == "single" else point
    try:
        exact = evaluate(STATIC[point.law], *given.exact)
    except Beyond:
        return None
    if exact.size > LARGEST[precision]:
        return None
    torque = given.model.torque(**given.channels, precision=precision)[0]
    allowed = {"double": DOUBLE, "single": SINGLE}[precision] * exact.size + SMALLEST[precision]
    return float(abs(float(torque) - exact.value) / allowed)


def error_of_gradient(point: Point) -> float | None:
    """The largest error of a derivative by a parameter, in multiples of what is allowed."""
    parameters, inputs = point.exact
    try:
        terms = STATIC[point.law]
        exact = evaluate(terms, parameters, inputs)
        size = gradient_size(PRINTED.get(point.law, terms), parameters, inputs)
    except Beyond:
        return None
    if max(size.values()) > LARGEST["double"]:
        return None
    model = point.model
    gradient = model.gradient(**point.channels)[0]
    return max(
        float(abs(slope - exact.gradient[p.symbol]) / (GRADIENT * size[p.symbol] + 1e-290))
        for p, slope in zip(model.parameters, gradient, strict=True)
    )


def assert_within(errors: Iterable[tuple[float | None, Point]], share: float = 0.9) -> None:
    """Every error is allowed, and at least this `share` of the points could be judged."""
    points = list(errors)
    judged = [(np.inf if np.isnan(e) else e, point) for e, point in points if e is not None]
    assert len(judged) >= share * len(points), f"{len(judged)} of {len(points)} points judged"
    error, point = max(judged, key=lambda pair: pair[0])
    assert error <= 1, f"{error:.3g} times the error allowed at {point}"


def test_every_law_has_a_reference() -> None:
    missing = set(STATIC_LAWS) - set(STATIC)
    assert not missing, f"no reference for {sorted(missing)}: write it in laws/reference.py"


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_values_at_random_points(law: str, precision: str) -> None:
    assert_within(((error_of_value(p, precision), p) for p in random_points(law, 60)), share=1)


@pytest.mark.parametrize("law", STATIC_LAWS)
def test_gradients_at_random_points(law: str) -> None:
    assert_within(((error_of_gradient(p), p) for p in random_points(law, 30)), share=1)


@pytest.mark.long
@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_values_at_a_thousand_points(law: str, precision: str) -> None:
    assert_within(((error_of_value(p, precision), p) for p in random_points(law, 1000)), share=1)


@pytest.mark.long
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_gradients_at_a_thousand_points(law: str) -> None:
    assert_within(((error_of_gradient(p), p) for p in random_points(law, 1000)), share=1)


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_values_at_special_points(law: str, precision: str) -> None:
    points = special_points(law, few(law))
    assert_within((error_of_value(p, precision), p) for p in points)


@pytest.mark.parametrize("law", STATIC_LAWS)
def test_gradients_at_special_points(law: str) -> None:
    points = special_points(law, 3 * few(law))
    assert_within((error_of_gradient(p), p) for p in points if has_digits(p))


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_values_at_all_special_points(law: str, precision: str) -> None:
    assert_within((error_of_value(p, precision), p) for p in special_points(law))


@pytest.mark.slow
@pytest.mark.parametrize("law", STATIC_LAWS)
def test_gradients_at_all_special_points(law: str) -> None:
    assert_within((error_of_gradient(p), p) for p in special_points(law) if has_digits(p))


def few(law: str) -> int:
    """The stride of a quick test: laws of speed alone have few special points."""
    return 7 if catalog()["laws"][law]["channels"] else 1


def has_digits(point: Point) -> bool:
    """Whether the speed is a normal number: a derivative by a speed's scale is relative to it."""
    return point.inputs["v"] == 0 or abs(point.inputs["v"]) > 1e-305
