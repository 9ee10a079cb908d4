"""The test of an added torque keeps its promise under noise with a memory."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom, f
from stribeck.identify.errors.added_torque import added_torque_test
from synthetic import ar1

TRIALS = 200


@pytest.mark.parametrize("rho", [0.0, 0.9])
@pytest.mark.parametrize("memory", [0.0, 0.95])
def test_chance_is_called_chance(rho: float, memory: float) -> None:
    """A regressor that has nothing to do with the noise passes 5 % about once in twenty."""
    rng = np.random.default_rng([7, int(10 * rho), int(100 * memory)])
    size, found = 4000, 0
    for _ in range(TRIALS):
        noise, x = ar1(rng, size, rho, 1.0), ar1(rng, size, memory, 1.0)
        added = x * (x @ noise) / (x @ x)
        found += added_torque_test(added, noise - added, 1) < 0.05
    assert found <= binom.ppf(0.999, TRIALS, 0.05), found
    # It is not blind either.
    assert found >= binom.ppf(0.001, TRIALS, 0.01)


def test_chance_of_several_parameters() -> None:
    """The best of three regressors at once counts as three."""
    rng = np.random.default_rng(8)
    size, found = 4000, 0
    for _ in range(TRIALS):
        noise = ar1(rng, size, 0.9, 1.0)
        x = np.column_stack([ar1(rng, size, 0.95, 1.0) for _ in range(3)])
        added = x @ np.linalg.lstsq(x, noise, rcond=None)[0]
        found += added_torque_test(added, noise - added, 3) < 0.05
    assert found <= binom.ppf(0.999, TRIALS, 0.05), found


def test_the_test_is_that_of_batch_means() -> None:
    """Slow noise has as few batches as are allowed, 20; the statistic is F distributed."""
    rng = np.random.default_rng(10)
    noise, x = ar1(rng, 4000, 0.99, 1.0), ar1(rng, 4000, 0.9, 0.1)
    for parameters in (1, 3):
        scores = (x * noise).reshape(20, 200).sum(axis=1)
        statistic = (x @ x) ** 2 / (20 * scores.var(ddof=1)) / parameters
        expected = f.sf(statistic, parameters, 20 - parameters)
        assert added_torque_test(x, noise, parameters) == pytest.approx(expected, rel=1e-9)


def test_a_cause_is_called_a_cause() -> None:
    rng = np.random.default_rng(9)
    noise, x = ar1(rng, 4000, 0.9, 1.0), ar1(rng, 4000, 0.95, 1.0)
    measured = noise + x
    added = x * (x @ measured) / (x @ x)
    assert added_torque_test(added, measured - added, 1) < 1e-6
    assert added_torque_test(np.zeros(4000), noise, 1) == 1.0
    assert added_torque_test(added, measured - added, 0) == 1.0
