"""Standard errors, and what the data can show."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.identify.errors.covariance import (
    batches,
    correlation_length,
    covariance_of,
    independent,
    sandwich,
    seen,
    variances,
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


@pytest.mark.parametrize("kind", ["white", "slow", "ramp"])
def test_correlation_length_is_the_windowed_sum(kind: str) -> None:
    """Sokal's window: lags up to five times the sum, or up to a quarter of the samples."""
    rng = np.random.default_rng(1)
    noise = {"white": rng.standard_normal(400), "slow": ar1(rng, 4000, 0.8, 1.0),
             "ramp": np.linspace(-3.0, 5.0, 400)}[kind]  # fmt: skip
    x = noise - noise.mean()
    expected, lag = 1.0, 0
    while lag < x.size // 4 and (lag == 0 or lag < 5.0 * max(expected, 1.0)):
        lag += 1
        expected += 2.0 * (x[lag:] @ x[:-lag]) / (x @ x)
    assert correlation_length(noise) == pytest.approx(max(expected, 1.0), rel=1e-9)


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


@pytest.mark.parametrize("count", [2, 7])
def test_sandwich_is_its_formula(count: int) -> None:
    """``H^-1 S H^-1`` with S from the sums of scores, `count` / (`count` - 1) of their spread."""
    rng = np.random.default_rng(5)
    j, r = rng.standard_normal((70, 2)), rng.standard_normal(70)
    batch = np.repeat(np.arange(count), 70 // count).astype(np.uint32)
    scores = np.array([j[batch == b].T @ r[batch == b] for b in range(count)])
    bread = np.linalg.inv(j.T @ j)
    expected = bread @ (count * np.cov(scores.T, ddof=1)) @ bread
    free = np.ones(2, dtype=bool)
    np.testing.assert_allclose(sandwich(j, r, batch, free), expected, rtol=1e-10)
    covariance, freedom = covariance_of(j, r, batch, free, 1e-4)
    np.testing.assert_allclose(covariance, expected, rtol=1e-10)
    assert freedom == count - 1
    # Without batches errors count as independent.
    covariance, freedom = covariance_of(j, r, None, free, 1e-4)
    np.testing.assert_allclose(covariance, r @ r / 68 * bread, rtol=1e-10)
    assert freedom == 68


def test_one_batch_or_too_few_samples_say_nothing() -> None:
    rng = np.random.default_rng(6)
    j, r, free = rng.standard_normal((9, 2)), rng.standard_normal(9), np.ones(2, dtype=bool)
    np.testing.assert_array_equal(sandwich(j, r, np.zeros(9, dtype=np.uint32), free), 0.0)
    for rows in (1, 2):
        np.testing.assert_array_equal(independent(j[:rows], r[:rows], free), np.zeros((2, 2)))


def test_independent_errors_are_the_textbook_formula() -> None:
    """A straight line through five points; Draper and Smith, section 1.4."""
    x = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    j = np.column_stack([np.ones(5), x])
    r = np.array([0.1, -0.2, 0.1, 0.1, -0.1])
    variance = r @ r / 3
    covariance = independent(j, r, np.ones(2, dtype=bool))
    assert covariance.shape == (2, 2)
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


def test_variance_of_a_parameter_and_of_independent_errors() -> None:
    """The second is the first over the parameter's diagonal element of ``(J'J)^-1``."""
    rng = np.random.default_rng(7)
    j, r = rng.standard_normal((60, 3)), rng.standard_normal(60)
    batch = np.repeat(np.arange(6), 10).astype(np.uint32)
    # The parameter is taken as free, whether it was or not.
    for held in (np.array([True, False, False]), np.array([True, False, True])):
        variance, independently = variances(j, r, batch, held, 2, 1e-4)
        among = np.array([True, False, True])
        expected = sandwich(j, r, batch, among)[2, 2]
        bread = np.linalg.inv(j[:, among].T @ j[:, among])[1, 1]
        assert variance == pytest.approx(expected, rel=1e-10)
        assert independently == pytest.approx(expected / bread, rel=1e-10)


@pytest.mark.filterwarnings("error")
def test_a_parameter_without_effect_has_an_infinite_variance() -> None:
    """Also where the squares of its tangent are no numbers any more; that of the other is kept."""
    rng = np.random.default_rng(9)
    shape, r = rng.standard_normal(60), rng.standard_normal(60)
    batch, free = np.repeat(np.arange(6), 10).astype(np.uint32), np.ones(2, dtype=bool)

    def of(size: float) -> list[np.ndarray]:
        j = np.column_stack([np.ones(60), size * shape])
        return [sandwich(j, r, batch, free), independent(j, r, free)]

    for usual, least in zip(of(1.0), of(2.0**-600), strict=True):
        assert least[1, 1] == np.inf and not np.isnan(least).any()
        assert least[0, 0] == usual[0, 0]
    # A power of two changes no digit.
    for usual, small in zip(of(1.0), of(2.0**-400), strict=True):
        assert small[1, 1] == usual[1, 1] * 2.0**800 and small[0, 0] == usual[0, 0]
    j = np.column_stack([np.ones(60), 2.0**-600 * shape])
    usual = variances(np.column_stack([np.ones(60), shape]), r, batch, free, 1, 1e-4)
    assert variances(j, r, batch, free, 1, 1e-4) == (np.inf, usual[1])
