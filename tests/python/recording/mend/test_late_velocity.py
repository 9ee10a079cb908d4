"""A recorded velocity that lags the position is not used: the position has the direction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from scipy.signal import lfilter
from stribeck.base.errors import RecordingError
from synthetic import COULOMB, joint, record

#: Time constant of the filter, s: 3.5 samples.
LAG = 0.035


def behind_a_filter(scale: float = 1.0, lag: float = LAG) -> pl.DataFrame:
    """A joint whose velocity is behind a low-pass filter of first order."""
    frame = joint()
    share = 0.01 / lag
    v = scale * frame["velocity"].to_numpy()
    late = lfilter([share], [1.0, share - 1.0], v, zi=[(1.0 - share) * v[0]])[0]
    return frame.with_columns(velocity=late)


def test_a_late_velocity_is_derived_from_the_position(tmp_path: Path) -> None:
    recording = record(tmp_path, behind_a_filter())
    assert recording.columns["velocity"].derived
    assert recording.columns["velocity"].source == "position"
    note = next(n for n in recording.notes if "lags the position" in n)
    assert "25 ms" in note
    truth = joint()["velocity"].to_numpy()
    wrong = np.sign(truth) != np.sign(recording.velocity)
    assert not (wrong & recording.moving).any()
    fit = sb.fit("coulomb", recording)
    assert fit.estimates["coulomb_friction"].value == pytest.approx(COULOMB, rel=0.01)
    as_recorded = record(tmp_path, behind_a_filter(), "trusted", trust=True)
    assert not as_recorded.columns["velocity"].derived
    assert fit.rmse < 0.5 * sb.fit("coulomb", as_recorded).rmse


def test_the_samples_that_move_are_those_of_the_recorded_velocity(tmp_path: Path) -> None:
    late = record(tmp_path, behind_a_filter())
    as_recorded = record(tmp_path, behind_a_filter(), "trusted", trust=True)
    assert late.velocity_threshold == as_recorded.velocity_threshold


@pytest.mark.parametrize("lag", [0.0, 0.011])
def test_less_than_a_sample_is_kept(tmp_path: Path, lag: float) -> None:
    frame = behind_a_filter(lag=lag) if lag else joint()
    assert not record(tmp_path, frame).columns["velocity"].derived


def test_a_velocity_of_another_scale_is_refused_as_before(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="velocity"):
        sb.fit("coulomb", record(tmp_path, behind_a_filter(scale=2.0)))
