"""The reference motion, delayed by the lag of the joint."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.identify.instrumental.reference_motion import along_reference, follows, lag

LATE = 0.013


@pytest.fixture(scope="module")
def late(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    time = np.arange(0.0, 10.0, 0.002)

    def motion(t: np.ndarray) -> np.ndarray:
        return np.sin(2.0 * t) + 0.3 * np.sin(7.0 * t)

    path = tmp_path_factory.mktemp("late") / "late.parquet"
    frame = {
        "time": time,
        "position": motion(time - LATE),
        "reference_position": motion(time),
        "torque": np.cos(time),
    }
    pl.DataFrame(frame).write_parquet(path)
    return sb.read(path)


def test_the_lag_is_found(late: sb.Recording) -> None:
    assert lag(late) == pytest.approx(LATE, rel=1e-2)
    assert follows(late)


def test_the_delayed_reference_is_the_motion(late: sb.Recording) -> None:
    along = along_reference(late)
    inside = slice(50, -50)
    assert along.position is not None and late.position is not None
    np.testing.assert_allclose(along.position[inside], late.position[inside], atol=1e-3)
    np.testing.assert_allclose(along.velocity[inside], late.velocity[inside], atol=1e-2)
    assert along.torque is late.torque
