"""Which samples belong to a regime, counted by hand."""

from __future__ import annotations

import numpy as np
from made_fits import Moved, left
from stribeck.diagnosis.residual.regimes import REVERSAL_WINDOW, regime_rows

#: Eight samples in motion, a rest of one sample at a reversal; speeds 1 to 8.
SPEED = np.array([1.0, 8.0, 2.0, 7.0, 0.0, -3.0, -6.0, -4.0, -5.0])


def chosen(recording: Moved) -> dict[str, list[int]]:
    """The samples of every regime."""
    rows = regime_rows(left(recording, np.zeros(recording.velocity.size)))
    return {name: np.flatnonzero(mask).tolist() for name, mask in rows.items()}


def test_speeds_directions_and_rest() -> None:
    found = chosen(Moved(SPEED))
    # A quarter of eight speeds: the quantiles lie between the second and the third.
    assert found["low_speed"] == [0, 2] and found["high_speed"] == [1, 3]
    assert found["forward"] == [0, 1, 2, 3] and found["backward"] == [5, 6, 7, 8]
    assert found["standstill"] == [4]
    assert found["start"] == [0, 1] and found["end"] == [7, 8]


def test_power_has_the_sign_of_torque_and_speed() -> None:
    found = chosen(Moved(SPEED, torque=np.array([1.0, -1.0, 0.0, 2.0, 9.0, 1.0, -1.0, 0.0, -2.0])))
    assert found["motoring"] == [0, 3, 6, 8] and found["generating"] == [1, 5]


def test_quarters_are_those_of_what_moves() -> None:
    warm = np.array([20.0, 28.0, 21.0, 27.0, -40.0, 22.0, 26.0, 23.0, 25.0])
    found = chosen(Moved(SPEED, temperature=warm))
    assert found["cold"] == [0, 2] and found["hot"] == [1, 3]
    same = np.where(SPEED == 0.0, 50.0, 20.0)
    assert not {"cold", "hot"} & set(chosen(Moved(SPEED, temperature=same)))
    assert not {"cold", "hot"} & set(chosen(Moved(SPEED)))


def test_a_drive_that_is_switched_off() -> None:
    off = np.array([True, True, False, True, False, True, True, True, False])
    found = chosen(Moved(SPEED, enabled=off))
    assert found["drive_on"] == [0, 1, 3, 5, 6, 7] and found["drive_off"] == [2, 8]
    always = np.ones(SPEED.size, dtype=bool)
    assert not {"drive_on", "drive_off"} & set(chosen(Moved(SPEED, enabled=always)))
    assert not {"drive_on", "drive_off"} & set(chosen(Moved(SPEED)))


def test_a_reversal_lasts_from_the_last_motion_to_the_first_one_back() -> None:
    """Two reversals: at once between samples 3 and 4, after a rest between 10 and 15."""
    sign = np.array([1.0] * 4 + [-1.0] * 7 + [0.0] * 4 + [1.0] * 5)
    # No two samples are as far apart as the window.
    time = 0.45 * REVERSAL_WINDOW * np.arange(sign.size)
    found = chosen(Moved(sign, time=time))["reversal"]
    assert found == [1, 2, 3, 4, 5, 6, 8, 9, 10, 15, 16, 17]
    # A segment that begins in the other direction has not turned.
    segment = np.repeat([0, 1], [8, 12])
    assert chosen(Moved(sign, time=time, segment=np.repeat([0, 1], [4, 16])))["reversal"] == [
        8, 9, 10, 15, 16, 17,
    ]  # fmt: skip
    # Each segment has its own clock.
    again = np.where(segment == 0, time, time - time[8])
    assert chosen(Moved(sign, time=again, segment=segment))["reversal"] == found
    assert chosen(Moved(sign, time=time, averaged=True))["reversal"] == []


def test_without_motion_nothing_turns() -> None:
    assert chosen(Moved(np.array([0.0, 1.0, 0.0])))["reversal"] == []
    assert chosen(Moved(np.array([1.0, -1.0]), time=np.array([0.0, 0.01])))["reversal"] == [0, 1]
