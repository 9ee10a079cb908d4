"""Numbers that no measurement has."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import RecordingError

TIME = np.arange(400) / 100.0


@pytest.mark.parametrize(
    ("factor", "said"),
    [(1e200, r"row \d+.*column 'torque': .* is beyond 1e\+100"), (1e-200, "is nowhere larger")],
)
def test_numbers_whose_squares_are_none_are_refused(factor: float, said: str) -> None:
    torque = np.sin(TIME)
    with pytest.raises(RecordingError, match=said):
        sb.Recording.from_columns(time=TIME, velocity=torque, torque=factor * torque)


def test_zeros_are_numbers() -> None:
    made = sb.Recording.from_columns(
        time=TIME, velocity=np.sin(TIME), torque=np.cos(TIME), load_torque=0.0 * TIME
    )
    assert made.load_torque is not None and not made.load_torque.any()
