"""Normal equations and their bounded solution."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from stribeck.identify.normal import NormalEquations, solve_bounded


@pytest.fixture
def system() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Columns, residual and group of 500 rows."""
    rng = np.random.default_rng(0)
    group = (np.arange(500) // 60).astype(np.uint32)
    return rng.standard_normal((500, 4)), rng.standard_normal(500), group


def test_sums_are_numpys(system: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    j, r, group = system
    sums = NormalEquations.of(j, r, group)
    assert sums.square.shape == (9,)
    for g in range(9):
        rows = group == g
        np.testing.assert_allclose(sums.matrix[g], j[rows].T @ j[rows], rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(sums.vector[g], j[rows].T @ r[rows], rtol=1e-12, atol=1e-12)
        assert sums.square[g] == pytest.approx(r[rows] @ r[rows], rel=1e-12)
    matrix, vector = sums.total()
    np.testing.assert_allclose(matrix, j.T @ j, rtol=1e-12, atol=1e-11)
    np.testing.assert_allclose(vector, j.T @ r, rtol=1e-11, atol=1e-11)
    again = NormalEquations.of(j, r, group)
    assert again.matrix.tobytes() == sums.matrix.tobytes()


def test_free_solution_is_least_squares(
    system: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    j, r, _ = system
    wide = np.full(4, np.inf)
    solved = solve_bounded(*NormalEquations.of(j, r).total(), -wide, wide)
    np.testing.assert_allclose(solved, np.linalg.lstsq(j, r, rcond=None)[0], rtol=1e-9)


def test_bounded_solution_is_scipys(system: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    j, r, _ = system
    scales = np.array([1.0, 1e4, 1e-5, 30.0])
    j = np.ascontiguousarray(j * scales)
    lower, upper = np.array([-0.01, 0.0, 0.0, -1.0]) / scales, np.full(4, 0.02) / scales
    solved = solve_bounded(*NormalEquations.of(j, r).total(), lower, upper)
    best = lsq_linear(j, r, (lower, upper), method="bvls", tol=1e-14)
    error = np.sum((j @ solved - r) ** 2)
    assert np.all(solved >= lower) and np.all(solved <= upper)
    assert error <= 2.0 * best.cost * (1.0 + 1e-9)


def test_directions_that_are_not_shown_stay_at_zero() -> None:
    rng = np.random.default_rng(1)
    x = rng.standard_normal(200)
    j = np.ascontiguousarray(np.column_stack([x, x, np.zeros(200)]))
    wide = np.full(3, np.inf)
    solved = solve_bounded(*NormalEquations.of(j, 3.0 * x).total(), -wide, wide)
    np.testing.assert_allclose(solved, [1.5, 1.5, 0.0], atol=1e-9)
    assert solve_bounded(np.zeros((0, 0)), np.zeros(0), np.zeros(0), np.zeros(0)).size == 0
