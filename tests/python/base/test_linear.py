"""Decompositions of the core against NumPy's, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from stribeck.base import linear
from stribeck.base.errors import FitError

Array = NDArray[np.float64]
SHAPES = [(1, 1), (5, 5), (9, 4), (4, 9), (3000, 12), (40, 30)]


def _matrix(shape: tuple[int, int], rank: int | None = None) -> Array:
    rng = np.random.default_rng(3)
    if rank is None:
        return rng.standard_normal(shape) * np.logspace(-2, 2, shape[1])
    return rng.standard_normal((shape[0], rank)) @ rng.standard_normal((rank, shape[1]))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("rank", [None, 1, 3])
def test_least_norm_is_that_of_lapack(shape: tuple[int, int], rank: int | None) -> None:
    if rank is not None and rank > min(shape):
        return
    matrix = _matrix(shape, rank)
    right = np.random.default_rng(4).standard_normal(shape[0])
    reference = np.linalg.lstsq(matrix, right, rcond=1e-10 if rank else None)[0]
    solved = linear.least_norm(matrix, right, 1e-10 if rank else None)
    size = np.linalg.norm(matrix, axis=0)
    np.testing.assert_allclose(solved * size, reference * size, atol=1e-9 * np.abs(right).max())


@pytest.mark.parametrize("rank", [None, 1, 3])
def test_squares_left_are_those_of_lapack(rank: int | None) -> None:
    columns = np.hstack([_matrix((3000, 12), rank), np.zeros((3000, 1))])
    targets = np.random.default_rng(4).standard_normal((3000, 3))
    solved = np.linalg.lstsq(columns, targets, rcond=1e-10)[0]
    expected = np.sum((targets - columns @ solved) ** 2, axis=0)
    np.testing.assert_allclose(linear.squares_left(columns, targets), expected, rtol=1e-9)
    exact = linear.squares_left(columns, columns[:, :2])
    np.testing.assert_allclose(exact, 0.0, atol=1e-12 * np.sum(columns[:, :2] ** 2))


@pytest.mark.parametrize("shape", SHAPES)
def test_singular_values_and_directions(shape: tuple[int, int]) -> None:
    matrix = _matrix(shape, min(shape))
    m, n = shape
    values, vectors = linear.singular(matrix)
    np.testing.assert_allclose(vectors @ vectors.T, np.eye(n), atol=1e-13)
    expected = np.zeros(n)
    expected[: min(m, n)] = np.linalg.svd(matrix, compute_uv=False)
    np.testing.assert_allclose(values, expected, atol=1e-13 * expected[0])
    np.testing.assert_allclose(
        vectors.T @ (values[:, None] ** 2 * vectors),
        matrix.T @ matrix,
        atol=1e-12 * expected[0] ** 2,
    )
    basis = linear.null_space(matrix, 1e-10)
    assert basis.shape == (n, max(n - m, 0))
    assert np.abs(matrix @ basis).max(initial=0.0) < 1e-12 * expected[0]


@pytest.mark.parametrize("size", [0, 1, 2, 7, 60])
def test_symmetric_eigen_and_solve(size: int) -> None:
    root = _matrix((size, size), size) + 2.0 * np.eye(size)
    matrix = root @ root.T + np.eye(size)
    values, vectors = linear.symmetric_eigen(matrix)
    np.testing.assert_allclose(vectors * values @ vectors.T, matrix, rtol=0, atol=1e-11 * size**2)
    assert np.all(np.diff(values) >= 0.0)
    right = np.arange(2.0 * size).reshape(size, 2)
    np.testing.assert_allclose(matrix @ linear.solve(matrix, right), right, atol=1e-8)
    np.testing.assert_allclose(matrix @ linear.solve(matrix, right[:, 0]), right[:, 0], atol=1e-8)


def test_pivots_take_the_longest_column_first() -> None:
    matrix = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 3.0], [0.0, 1e-3, 0.0]])
    assert linear.pivots(matrix).tolist() == [2, 1, 0]
    assert linear.pivots(np.zeros((2, 3))).size == 3


def test_what_is_not_finite_or_singular_is_refused() -> None:
    bad, right = np.array([[1.0, np.nan], [0.0, 1.0]]), np.ones(2)
    for refused in (
        lambda: linear.least_norm(bad, right),
        lambda: linear.singular(bad),
        lambda: linear.symmetric_eigen(np.tril(bad.T)),
        lambda: linear.pivots(bad),
        lambda: linear.solve(bad, right),
        lambda: linear.solve(np.ones((2, 2)), right),
        lambda: linear.solve(np.ones((2, 2)), np.ones(3)),
    ):
        with pytest.raises(FitError, match="a linear system of the fit has no solution: "):
            refused()


def test_nothing_to_solve() -> None:
    assert linear.least_norm(np.zeros((3, 0)), np.ones(3)).size == 0
    values, vectors = linear.singular(np.zeros((0, 0)))
    assert values.size == 0 and vectors.shape == (0, 0)
    assert not linear.least_norm(np.zeros((3, 2)), np.ones(3)).any()
