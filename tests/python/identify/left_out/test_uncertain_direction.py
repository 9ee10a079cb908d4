"""A velocity that lags the position is noticed, and its uncertain directions are not fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.left_out import rows
from stribeck.identify.left_out.uncertain_direction import late_velocity, uncertain_direction
from synthetic import COULOMB, behind_a_filter, joint, record

#: Time constant of the filter, s: 3.5 samples.
LAG = 0.035


def test_the_lag_follows_from_position_and_velocity(tmp_path: Path) -> None:
    late = late_velocity(record(tmp_path, behind_a_filter(joint(), LAG), trust=True))
    # The discrete filter is a sample faster than its time constant.
    assert late is not None and late.lag == pytest.approx(LAG - 0.01, abs=1e-3)


def test_an_ordinary_velocity_is_not_late(tmp_path: Path, plain: sb.Recording) -> None:
    assert late_velocity(plain) is None
    assert not uncertain_direction(plain).any()
    derived = record(tmp_path, joint().drop("velocity", "acceleration"))
    assert late_velocity(derived) is None
    # Less than a sample leaves no direction uncertain.
    assert late_velocity(record(tmp_path, behind_a_filter(joint(), 0.011), "quick")) is None


def test_samples_before_a_late_reversal_are_neither_fitted_nor_scored(tmp_path: Path) -> None:
    recording = record(tmp_path, behind_a_filter(joint(), LAG), trust=True)
    marked = uncertain_direction(recording)
    truth = joint()["velocity"].to_numpy()
    wrong = (np.sign(truth) != np.sign(recording.velocity)) & recording.moving
    assert wrong.sum() > 20
    assert marked[wrong].mean() > 0.9
    assert marked.mean() < 3 * wrong.mean()
    fit = sb.fit("coulomb", recording)
    assert not np.isin(np.flatnonzero(marked), fit.rows).any()
    assert not (marked & fit.scored).any()
    assert any("lags the position by" in note for note in fit.notes)
    assert fit.estimates["coulomb_friction"].value == pytest.approx(COULOMB, rel=0.01)


def test_where_all_samples_are_in_doubt_all_are_scored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise there would be no error to state."""
    recording = record(tmp_path, joint())
    monkeypatch.setattr(rows, "uncertain_direction", lambda r: np.ones(r.rows, dtype=bool))
    assert np.array_equal(rows.scored_rows(recording), recording.moving)
