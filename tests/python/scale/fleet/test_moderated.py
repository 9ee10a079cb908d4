"""Differences of few days, weighed by the scatter of many joints."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import polygamma
from scipy.stats import false_discovery_control
from stribeck.scale.fleet.moderated import (
    Difference,
    Scatter,
    _inverse_trigamma,
    common_scatter,
    difference,
    false_discovery,
    moderated,
    two_sided,
)


def draw(rng: np.random.Generator, scatter: float, days: int = 4, shift: float = 0.0) -> Difference:
    """A joint whose days scatter by `scatter` times what their standard errors say."""
    errors = np.full(days, 0.1)
    before = 5.0 + scatter * errors * rng.standard_normal(days)
    after = 5.0 + shift + scatter * errors * rng.standard_normal(days)
    return difference(before, after, errors, errors)


def test_the_difference_of_weighted_means() -> None:
    found = difference(np.array([1.0, 3.0]), np.array([4.0]), np.array([1.0, 0.5]), np.array([0.5]))
    assert found.before == pytest.approx((1.0 + 4.0 * 3.0) / 5.0)
    assert found.change == pytest.approx(4.0 - 2.6)
    assert found.stderr == pytest.approx(math.sqrt(1.0 / 5.0 + 1.0 / 4.0))
    assert found.freedom == 1
    assert found.ratio == pytest.approx((1.0 - 2.6) ** 2 + 4.0 * (3.0 - 2.6) ** 2)


def test_a_scatter_that_all_joints_share_is_found() -> None:
    rng = np.random.default_rng(1)
    common = common_scatter([draw(rng, 3.0) for _ in range(200)])
    assert common.ratio == pytest.approx(9.0, rel=0.1)
    assert common.freedom > 3 * 6


def test_joints_that_scatter_each_in_its_way_keep_more_of_their_own() -> None:
    rng = np.random.default_rng(2)
    found = [draw(rng, math.exp(rng.normal())) for _ in range(300)]
    common = common_scatter(found)
    assert common.freedom < 8.0
    wild = max(found, key=lambda d: d.ratio)
    stderr, freedom = moderated(wild, common)
    assert freedom == pytest.approx(wild.freedom + common.freedom)
    assert wild.stderr * math.sqrt(common.ratio) < stderr < wild.stderr * math.sqrt(wild.ratio)


@pytest.mark.parametrize("days", [1, 2, 5])
def test_chance_alone_is_taken_for_a_change_as_often_as_said(days: int) -> None:
    rng = np.random.default_rng(days)
    small = []
    for _ in range(100):
        found = [draw(rng, 4.0, days) for _ in range(12)]
        common = common_scatter(found)
        small += [two_sided(d.change, *moderated(d, common)) < 0.05 for d in found]
    assert np.mean(small) == pytest.approx(0.05, abs=0.025)


def test_standard_errors_are_never_undercut() -> None:
    calm = Difference(1.0, 2.0, 0.1, 0.01, 6)
    assert moderated(calm, Scatter(0.02, 50.0))[0] == 0.1
    assert moderated(Difference(1.0, 2.0, 0.1, math.nan, 0), Scatter()) == (0.1, math.inf)


def test_adjusted_p_values_are_those_of_benjamini_and_hochberg() -> None:
    p = [0.04, 0.001, 0.2, 0.011, 0.9, 0.011]
    assert false_discovery(p) == pytest.approx(list(false_discovery_control(p)))


@pytest.mark.parametrize("value", [1e-3, 0.3, 1.0, 40.0])
def test_trigamma_is_inverted(value: float) -> None:
    assert polygamma(1, _inverse_trigamma(value)) == pytest.approx(value, rel=1e-9)
