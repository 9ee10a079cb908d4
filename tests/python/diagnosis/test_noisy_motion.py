"""Noise of the motion is no delay: the mean of two samples has less noise than one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.diagnosis.measurement.noisy_motion import NOISY_MOTION
from stribeck.diagnosis.measurement.table import imitating
from synthetic import joint, record, sticking_joint


def noisy(noise: float) -> pl.DataFrame:
    """A joint that lacks nothing, whose acceleration is recorded with noise."""
    return sticking_joint(1e-3, 0.05, acceleration_noise=noise, seed=4)


def test_the_mean_of_two_samples_is_no_delay(tmp_path: Path) -> None:
    recording = record(tmp_path, noisy(0.4))
    before = sb.fit("coulomb", recording)
    # A fifth of a sample lowers the error in either direction.
    for delay in (-0.001, 0.001):
        late = sb.fit("coulomb+delay", recording, fix={"delay": delay})
        assert late.rmse < 0.99 * before.rmse
    assert sb.improve("coulomb", recording).steps == ()


def test_a_delay_is_found_beside_the_noise(tmp_path: Path) -> None:
    frame = noisy(0.2)
    late = np.interp(frame["time"].to_numpy() - 0.012, frame["time"], frame["torque"])
    found = sb.improve("coulomb", record(tmp_path, frame.with_columns(torque=late)))
    assert [step.finding.effect for step in found.steps][:1] == ["delay"]


def test_it_imitates_a_delay_alone() -> None:
    """A drive train smooths the load torque, and stands beside the noise of that."""
    assert NOISY_MOTION.what in imitating("delay")
    assert NOISY_MOTION.what not in imitating("elasticity")
    averaged = sb.read(
        {"time": np.arange(9.0), "velocity": np.arange(1.0, 10.0), "torque": np.ones(9)},
        average="row",
    )
    assert NOISY_MOTION.columns(sb.fit("coulomb", averaged)) == []


def test_a_torque_that_changes_steadily_has_no_such_noise(tmp_path: Path) -> None:
    """What a delay adds to first order is not in the column."""
    fit = sb.fit("coulomb", record(tmp_path, joint()))
    (column,) = NOISY_MOTION.columns(fit)
    np.testing.assert_allclose(column[1:-1], np.diff(fit.prediction, 2) / 2.0, atol=1e-12)
