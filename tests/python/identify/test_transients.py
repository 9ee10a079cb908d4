"""Stretches that no friction model explains are found, and nothing else is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.transients import stretches, transient_rows
from synthetic import joint, motion, record


def blow() -> np.ndarray:
    """A blow of 40 N m between 12 and 12.4 s."""
    t = motion()[0]
    return np.where((t > 12.0) & (t < 12.4), 40.0 * np.sin(31.4 * (t - 12.0)), 0.0)


def test_an_ordinary_recording_has_none(plain: sb.Recording) -> None:
    assert not transient_rows(plain).any()
    v = motion()[2]
    assert stretches(plain, np.zeros(v.size, dtype=bool)) == []


def test_a_blow_is_found_reported_and_not_fitted_to(tmp_path: Path, plain: sb.Recording) -> None:
    recording = record(tmp_path, joint(blow()))
    marked = transient_rows(recording)
    t = recording.time
    assert marked[(t > 12.0) & (t < 12.4) & recording.moving].all()
    assert marked.mean() < 0.1
    ((start, end),) = stretches(recording, marked)
    assert start < 12.05 and end > 12.3
    fit = sb.fit("coulomb", recording)
    assert fit.to_dict()["transients"] == [[start, end]]
    # It is scored all the same: the rows are the same for every model.
    assert fit.rmse > 5.0 * sb.fit("coulomb", plain).rmse
    assert fit.estimates["coulomb_friction"].value == pytest.approx(3.0, rel=0.01)


def test_what_comes_again_and_again_is_no_transient(tmp_path: Path) -> None:
    """A torque of any size that repeats is something to be explained."""
    v = motion()[2]
    extra = 20.0 * np.exp(-((v / 0.05) ** 2)) * np.sign(v)
    assert not transient_rows(record(tmp_path, joint(extra))).any()
