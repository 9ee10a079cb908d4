"""A recorded velocity that lags the position is not used: the position has the direction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import RecordingError
from synthetic import COULOMB, behind_a_filter, joint, record

#: Time constant of the filter, s: 3.5 samples.
LAG = 0.035


def late_joint(scale: float = 1.0, lag: float = LAG) -> pl.DataFrame:
    """A joint whose velocity is behind a low-pass filter of first order."""
    return behind_a_filter(joint().with_columns(velocity=scale * pl.col("velocity")), lag)


def test_a_late_velocity_is_derived_from_the_position(tmp_path: Path) -> None:
    recording = record(tmp_path, late_joint())
    assert recording.columns["velocity"].derived
    assert recording.columns["velocity"].source == "position"
    note = next(n for n in recording.notes if "lags the position" in n)
    assert "25 ms" in note
    truth = joint()["velocity"].to_numpy()
    wrong = np.sign(truth) != np.sign(recording.velocity)
    assert not (wrong & recording.moving).any()
    fit = sb.fit("coulomb", recording)
    assert fit.estimates["coulomb_friction"].value == pytest.approx(COULOMB, rel=0.01)
    as_recorded = record(tmp_path, late_joint(), "trusted", trust=True)
    assert not as_recorded.columns["velocity"].derived
    assert fit.rmse < 0.5 * sb.fit("coulomb", as_recorded).rmse


def test_the_samples_that_move_are_those_of_the_recorded_velocity(tmp_path: Path) -> None:
    late = record(tmp_path, late_joint())
    as_recorded = record(tmp_path, late_joint(), "trusted", trust=True)
    assert late.velocity_threshold == as_recorded.velocity_threshold


def test_the_noise_of_the_derived_velocity_hides_slow_samples(tmp_path: Path) -> None:
    """The filter leaves less noise in the recorded velocity than the position has."""
    noise = 2e-4 * np.random.default_rng(8).standard_normal(late_joint().height)
    frame = late_joint().with_columns(position=pl.col("position") + noise)
    late = record(tmp_path, frame)
    assert late.columns["velocity"].source == "position"
    as_recorded = record(tmp_path, frame, "trusted", trust=True)
    assert late.velocity_threshold > 2.0 * as_recorded.velocity_threshold
    wrong = np.sign(joint()["velocity"].to_numpy()) != np.sign(late.velocity)
    assert not (wrong & late.moving).any()


def moves_with_rests(lag: float) -> pl.DataFrame:
    """Moves that end in a rest, held by friction in the direction of the move before it."""
    rng, rate = np.random.default_rng(4), 100.0
    pieces, side = [np.zeros(200)], 1.0
    for _ in range(20):
        ramp, cruise, rest = (int(n) for n in rng.integers((60, 50, 150), (120, 200, 300)))
        a = rng.uniform(1.0, 3.0)
        pieces += [np.full(ramp, side * a), np.zeros(cruise), np.full(ramp, -side * a)]
        pieces += [np.zeros(rest)]
        side = -side
    a = np.concatenate(pieces)
    v = np.cumsum(a) / rate
    v[np.abs(v) < 1e-9] = 0.0
    direction = pl.Series(np.where(v == 0.0, np.nan, np.sign(v))).fill_nan(None)
    held = direction.fill_null(strategy="forward").fill_null(0.0).to_numpy()
    friction = np.where(v == 0.0, 0.8 * COULOMB * held, COULOMB * np.sign(v)) + 0.5 * v
    frame = pl.DataFrame(
        {
            "time": np.arange(v.size) / rate,
            "position": np.cumsum(v) / rate + 1e-4 * rng.standard_normal(v.size),
            "velocity": v,
            "torque": friction + 0.2 * a + 0.02 * rng.standard_normal(v.size),
        }
    )
    noise = 0.02 * rng.standard_normal(v.size)
    return behind_a_filter(frame, lag).with_columns(velocity=pl.col("velocity") + noise)


def test_what_holds_a_joint_at_rest_does_not_keep_a_late_velocity(tmp_path: Path) -> None:
    """Long after each stop the velocity still decays, in the direction of what holds the joint."""
    recording = record(tmp_path, moves_with_rests(2.0 * LAG))
    assert recording.columns["velocity"].derived
    fit = sb.fit("coulomb", recording, starts=1)
    assert fit.estimates["coulomb_friction"].value == pytest.approx(COULOMB, rel=0.02)


@pytest.mark.parametrize("samples", [-3, 4, 6])
def test_a_late_torque_does_not_keep_a_late_velocity(samples: int, tmp_path: Path) -> None:
    late = late_joint().with_columns(
        pl.col("torque", "load_torque").shift(samples).backward_fill().forward_fill()
    )
    assert record(tmp_path, late).columns["velocity"].derived


@pytest.mark.parametrize(
    ("lag", "derived"), [(0.01, False), (0.011, False), (0.014, False), (0.018, True)]
)
def test_less_than_half_a_sample_is_kept(tmp_path: Path, lag: float, derived: bool) -> None:
    """The discrete filter is a sample of 0.01 s faster than its time constant."""
    assert record(tmp_path, late_joint(lag=lag)).columns["velocity"].derived is derived


def test_a_velocity_late_by_a_sample_is_no_inertia(tmp_path: Path) -> None:
    """Viscous friction of a late velocity is that of the velocity, less a share of acceleration."""
    frame = joint(rows=4000)
    late = frame.with_columns(velocity=pl.col("velocity").shift(1).fill_null(strategy="backward"))
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, late.drop("acceleration"))))
    assert not found.findings


def test_a_velocity_of_another_scale_is_refused_as_before(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="velocity"):
        sb.fit("coulomb", record(tmp_path, late_joint(scale=2.0)))
