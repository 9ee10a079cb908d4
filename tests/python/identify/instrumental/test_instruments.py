"""Projection on instruments, and errors that least squares with projected columns gives."""

from __future__ import annotations

import numpy as np
from stribeck.identify.errors.covariance import independent, sandwich
from stribeck.identify.instrumental.instruments import fitted_columns, projected

RNG = np.random.default_rng(5)
N, P = 400, 3
TRUE = np.array([1.0, -2.0, 0.5])
MOTION = RNG.normal(size=(N, P))
NOISE = 0.7 * RNG.normal(size=(N, P))
COLUMNS = MOTION + NOISE
INSTRUMENTS = MOTION @ np.array([[1.0, 0.2, 0.0], [0.0, 1.0, 0.1], [0.3, 0.0, 1.0]])
TORQUE = MOTION @ TRUE + 0.1 * RNG.normal(size=N)


def test_the_step_solves_the_instrumental_equations() -> None:
    factor, right = projected(INSTRUMENTS, COLUMNS, TORQUE)
    step = np.linalg.solve(factor, right)
    expected = np.linalg.solve(INSTRUMENTS.T @ COLUMNS, INSTRUMENTS.T @ TORQUE)
    np.testing.assert_allclose(step, expected, rtol=1e-10)
    squares = np.linalg.lstsq(COLUMNS, TORQUE)[0]
    assert np.abs(step - TRUE).max() < 0.15 < np.abs(squares - TRUE).max()


def test_errors_of_projected_columns_are_those_of_the_instruments() -> None:
    """``(Z'J)^-1 S (J'Z)^-1`` with S from batches, and ``s^2 (J'P J)^-1``."""
    expected = np.linalg.solve(INSTRUMENTS.T @ COLUMNS, INSTRUMENTS.T @ TORQUE)
    residual = TORQUE - COLUMNS @ expected
    fitted = fitted_columns(INSTRUMENTS, COLUMNS, residual)
    batch = (np.arange(N) * 20 // N).astype(np.uint32)
    free = np.ones(P, dtype=bool)
    scores = np.stack([INSTRUMENTS[batch == b].T @ residual[batch == b] for b in range(20)])
    scores -= scores.mean(axis=0)
    inverse = np.linalg.inv(INSTRUMENTS.T @ COLUMNS)
    textbook = inverse @ (scores.T @ scores * 20 / 19) @ inverse.T
    np.testing.assert_allclose(sandwich(fitted, residual, batch, free), textbook, rtol=1e-8)
    plain = inverse @ (INSTRUMENTS.T @ INSTRUMENTS) @ inverse.T * (residual @ residual) / (N - P)
    np.testing.assert_allclose(independent(fitted, residual, free), plain, rtol=1e-8)


def test_dependent_instruments_are_no_instruments() -> None:
    """A column twice and a zero column leave a projection on what is there."""
    twice = INSTRUMENTS.copy()
    twice[:, 1] = 2.0 * twice[:, 0]
    twice[:, 2] = 0.0
    factor, right = projected(twice, COLUMNS, TORQUE)
    assert np.all(factor[1:] == 0.0) and np.all(right[1:] == 0.0)
    assert abs(right[0]) > 0.0
