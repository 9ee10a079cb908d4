"""Standard errors, and what the data can show."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.identify.covariance import (
    batches,
    correlation_length,
    independent,
    sandwich,
    seen,
)
from synthetic import ar1


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
def test_correlation_length_of_known_noise(rho: float) -> None:
    """An AR(1) process remembers itself over (1 + rho)/(1 - rho) samples."""
    noise = ar1(np.random.default_rng(0), 50_000, rho, 1.0)
    found = correlation_length(noise)
    assert found == pytest.approx((1.0 + rho) / (1.0 - rho), rel=0.15)


def test_correlation_length_of_nothing_is_one() -> None:
    assert correlation_length(np.zeros(100)) == 1.0
    assert correlation_length(np.ones(3)) == 1.0


def test_batches_are_contiguous_and_longer_than_the_memory() -> None:
    batch = batches(10_000, 30.0)
    assert np.all(np.diff(batch.astype(int)) >= 0) and set(np.diff(batch.astype(int))) <= {0, 1}
    assert np.bincount(batch).min() >= 4 * 30
    assert batches(10_000, 1e9).max() + 1 == 10
    assert batches(10_000, 1.0).max() + 1 == 200
    assert batches(4, 1.0).max() + 1 == 4


def test_sandwich_of_white_noise_is_the_textbook_formula() -> None:
    rng = np.random.default_rng(3)
    j = rng.standard_normal((20_000, 3)) * np.array([1.0, 100.0, 1e-3])
    r = 0.7 * rng.standard_normal(20_000)
    free = np.ones(3, dtype=bool)
    covariance = sandwich(j, r, batches(r.size, 1.0), free)
    expected = 0.7**2 * np.linalg.inv(j.T @ j)
    np.testing.assert_allclose(np.diag(covariance), np.diag(expected), rtol=0.3)
    # A parameter that is held has no error and lends none.
    held = sandwich(j, r, batches(r.size, 1.0), np.array([True, False, True]))
    assert held[1, 1] == 0.0 and held[0, 0] > 0.0


def test_independent_errors_are_the_textbook_formula() -> None:
    """A straight line through five points; Draper and Smith, section 1.4."""
    x = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    j = np.column_stack([np.ones(5), x])
    r = np.array([0.1, -0.2, 0.1, 0.1, -0.1])
    variance = r @ r / 3
    covariance = independent(j, r, np.ones(2, dtype=bool))
    assert covariance[1, 1] == pytest.approx(variance / 10.0, rel=1e-12)
    assert covariance[0, 0] == pytest.approx(variance * (0.2 + 9.0 / 10.0), rel=1e-12)
    held = independent(j, r, np.array([False, True]))
    assert held[0, 0] == 0.0 and held[1, 1] == pytest.approx(r @ r / 4 / 55.0, rel=1e-12)


def test_collinear_and_absent_columns_are_not_seen() -> None:
    rng = np.random.default_rng(4)
    a, b = rng.standard_normal((2, 1000))
    j = np.column_stack([a, b, a + b, np.zeros(1000), rng.standard_normal(1000)])
    shown = seen(j, np.ones(5, dtype=bool))
    np.testing.assert_array_equal(shown, [False, False, False, False, True])
    held = np.array([True, True, False, True, True])
    np.testing.assert_array_equal(seen(j, held), [True, True, False, False, True])
    # The size of a column does not matter.
    scaled = seen(np.column_stack([a, 1e-9 * b]), np.ones(2, dtype=bool))
    assert scaled.all()
