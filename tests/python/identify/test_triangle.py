"""Triangular factors of least-squares problems and their bounded solution."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from stribeck.identify.triangle import Triangle, triangles

FREE = np.full(4, np.inf)


@pytest.fixture
def system() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Columns of very different sizes, residual and group of 500 rows."""
    rng = np.random.default_rng(0)
    columns = rng.standard_normal((500, 4)) * np.array([1.0, 1e-160, 1e5, 1e170])
    return columns, rng.standard_normal(500), (np.arange(500) // 60).astype(np.uint32)


def test_free_solution_is_least_squares(
    system: tuple[np.ndarray, np.ndarray, np.ndarray],
) -> None:
    j, r, _ = system
    size = np.abs(j).max(axis=0)
    expected = np.linalg.lstsq(j / size, r, rcond=None)[0] / size
    triangle = Triangle.of(j, r)
    step = triangle.solve(-FREE, FREE)
    np.testing.assert_allclose(step, expected, rtol=1e-12)
    left = r - (j * step).sum(axis=1)
    assert triangle.rest == pytest.approx(np.linalg.norm(left), rel=1e-12)
    assert triangle.square == pytest.approx(r @ r, rel=1e-12)
    assert triangle.fall(step) == pytest.approx(r @ r - left @ left, rel=1e-10)


def test_groups_join_to_the_whole(system: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    j, r, group = system
    parts = triangles(j, r, group, 9)
    whole, joined = Triangle.of(j, r), Triangle.joined(parts)
    np.testing.assert_allclose(joined.solve(-FREE, FREE), whole.solve(-FREE, FREE), rtol=1e-12)
    assert joined.rest == pytest.approx(whole.rest, rel=1e-12)
    again = triangles(j, r, group, 9)
    assert all(a.factor.tobytes() == b.factor.tobytes() for a, b in zip(parts, again, strict=True))


def test_bounds_and_damping(system: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    j, r, _ = system
    size = np.abs(j).max(axis=0)
    bound = 0.01 / size
    expected = lsq_linear(j / size, r, bounds=(-0.01, 0.01), method="bvls").x / size
    np.testing.assert_allclose(Triangle.of(j, r).solve(-bound, bound), expected, rtol=1e-9)
    damping = 3.0 * size
    stacked = np.vstack([j / size, 3.0 * np.eye(4)])
    damped = np.linalg.lstsq(stacked, np.r_[r, np.zeros(4)], rcond=None)[0] / size
    step = Triangle.of(j, r).solve(-FREE, FREE, damping)
    np.testing.assert_allclose(step, damped, rtol=1e-12)


def test_what_the_data_does_not_show_stays() -> None:
    rng = np.random.default_rng(1)
    a = rng.standard_normal(100)
    triangle = Triangle.of(np.column_stack([a, a, np.zeros(100)]), 2.0 * a)
    step = triangle.solve(-FREE[:3], FREE[:3])
    np.testing.assert_allclose(step, [1.0, 1.0, 0.0], atol=1e-12)


def test_covariance_keeps_digits_that_normal_equations_lose() -> None:
    """Columns 1 and 1 + 1e-7 x: J'J is singular to working precision."""
    x = np.linspace(-1.0, 1.0, 201)
    triangle = Triangle.of(np.column_stack([np.ones_like(x), 1.0 + 1e-7 * x]), np.zeros_like(x))
    expected = 1e14 / (x @ x)
    assert triangle.covariance()[1, 1] == pytest.approx(expected, rel=1e-6)


def test_a_column_that_all_but_vanishes_in_one_group() -> None:
    """Its squares underflow there: a sigmoid's slope, where that block has no slow samples."""
    rng = np.random.default_rng(2)
    j, r = rng.standard_normal((200, 2)), rng.standard_normal(200)
    group = (np.arange(200) // 100).astype(np.uint32)
    j[group == 1, 1] *= 1e-160
    joined = Triangle.joined(triangles(j, r, group, 2))
    assert np.all(np.isfinite(joined.factor)) and np.all(np.isfinite(joined.right))
    expected = np.linalg.lstsq(j, r, rcond=None)[0]
    np.testing.assert_allclose(joined.solve(-FREE[:2], FREE[:2]), expected, rtol=1e-12)
