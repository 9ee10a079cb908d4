"""The test of an added torque keeps its promise under noise with a memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.stats import binom, f
from stribeck.diagnosis.trials.evidence import (
    Difference,
    added_torque_test,
    difference,
    evidence,
    held_out_square,
)
from stribeck.diagnosis.trials.trial import Trial, tie_statistic
from synthetic import ar1, joint, motion, record

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


def test_a_difference_without_error_is_certain() -> None:
    assert Difference(1.0, 0.0).statistic == np.inf
    assert Difference(0.0, 1.0).statistic == Difference(-1.0, 1.0).statistic == 0.0
    assert Difference(3.0, 2.0).statistic == 1.5


def test_a_cause_is_called_a_cause() -> None:
    rng = np.random.default_rng(9)
    noise, x = ar1(rng, 4000, 0.9, 1.0), ar1(rng, 4000, 0.95, 1.0)
    measured = noise + x
    added = x * (x @ measured) / (x @ x)
    assert added_torque_test(added, measured - added, 1) < 1e-6
    assert added_torque_test(np.zeros(4000), noise, 1) == 1.0
    assert added_torque_test(added, measured - added, 0) == 1.0


def test_evidence_of_a_real_effect_and_of_none(tmp_path: Path, plain: sb.Recording) -> None:
    offset = record(tmp_path, joint(0.1), "offset")
    before, after = sb.fit("coulomb", offset), sb.fit("coulomb+offset", offset)
    found = evidence(before, after)
    rows = before.rows
    fall = 1.0 - np.sqrt(
        np.sum(after.held_out_residual[rows] ** 2) / np.sum(before.held_out_residual[rows] ** 2)
    )
    assert found.fall == pytest.approx(fall, rel=1e-9) and found.fall > 0.5
    assert found.everywhere and found.fall_in_band > 0.5 and found.p_value < 1e-9
    nothing = evidence(sb.fit("coulomb", plain), sb.fit("coulomb+offset", plain))
    assert nothing.fall < 0.01 and nothing.p_value > 1e-3


def test_one_event_is_not_everywhere(tmp_path: Path) -> None:
    """What a single block gains is no effect."""
    t = motion()[0]
    once = record(tmp_path, joint(np.where((t > 9.0) & (t < 11.5), 0.3, 0.0)))
    found = evidence(sb.fit("coulomb", once), sb.fit("coulomb+offset", once))
    assert found.fall < 0.01


def test_difference_is_a_mean_and_its_error(tmp_path: Path) -> None:
    offset = record(tmp_path, joint(0.1), "offset")
    worse, better = sb.fit("coulomb", offset), sb.fit("coulomb+offset", offset)
    found = difference(worse, better)
    rows = worse.rows
    total = np.sum(worse.held_out_residual[rows] ** 2 - better.held_out_residual[rows] ** 2)
    assert found.total == pytest.approx(total) and found.statistic > 5.0
    assert found.statistic == pytest.approx(found.total / found.error)
    for fit in (worse, better):
        square = np.sum(fit.held_out_residual[rows] ** 2)
        assert held_out_square(fit, worse) == pytest.approx(square)
    assert difference(better, worse).statistic == 0.0


def test_causes_outside_friction_are_compared_at_reversals_too(tmp_path: Path) -> None:
    """A delay shows most where dry friction changes its sign, which no law is fitted to."""
    frame = joint()
    late = np.interp(frame["time"] - 0.02, frame["time"], frame["torque"])
    delayed = record(tmp_path, frame.with_columns(torque=pl.Series(late)), "late")
    before = sb.fit("coulomb", delayed)
    delay, inertia, curve = (
        Trial(effect, after, evidence(before, after))
        for effect in ("delay", "inertia", "nonlinear_viscous")
        for after in [sb.fit(f"coulomb+{effect}", delayed)]
    )
    scored = difference(inertia.fit, delay.fit)
    everywhere = difference(inertia.fit, delay.fit, everywhere=True)
    assert everywhere.total > scored.total > 0.0
    assert tie_statistic(delay, inertia) == everywhere.statistic
    assert tie_statistic(delay, curve) == difference(curve.fit, delay.fit).statistic
