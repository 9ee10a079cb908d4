"""Rows that a logger wrote without new values."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
from stribeck import read
from stribeck.base.errors import RecordingError
from synthetic import joint

ROWS = 4000
CHANNELS = ("position", "velocity", "torque")


def held(frame: pl.DataFrame, changes: np.ndarray, channels: tuple[str, ...]) -> pl.DataFrame:
    """The frame with channels that keep the value of the last row of `changes`."""
    last = changes[np.searchsorted(changes, np.arange(frame.height), side="right") - 1]
    return frame.with_columns(**{c: frame[c].to_numpy()[last] for c in channels})


def test_a_logger_that_writes_faster_than_channels_change(write):
    """Each third or so row has new values: those rows are the recording."""
    frame = joint(rows=ROWS, rate=300.0).select("time", *CHANNELS)
    changes = np.unique(np.r_[0, np.cumsum(np.random.default_rng(1).integers(2, 5, ROWS))])
    changes = changes[changes < ROWS]
    recording = read(write(held(frame, changes, CHANNELS)))
    note = next(note for note in recording.notes if "repeat the row before" in note)
    assert note.startswith(f"{ROWS - changes.size} of {ROWS} rows repeat the row before and are")
    assert "written every 3.33 ms" in note and "change about every 10 ms" in note
    np.testing.assert_array_equal(recording.time, frame["time"].to_numpy()[changes])
    assert recording.gaps == 0


def test_of_channels_updated_one_after_the_other_the_last_row_is_complete(write):
    """The load torque follows one row after the other channels, and all hold for 15 rows."""
    frame = joint(rows=ROWS, rate=1000.0)
    changes = np.arange(0, ROWS, 15)
    written = held(frame, changes, CHANNELS)
    late = np.roll(held(frame, changes, ("load_torque",))["load_torque"].to_numpy(), 1)
    recording = read(write(written.with_columns(load_torque=late)))
    kept = changes[1:] + 1
    np.testing.assert_array_equal(recording.time[-kept.size :], frame["time"].to_numpy()[kept])
    torque = frame["torque"].to_numpy()[changes[1:]]
    np.testing.assert_array_equal(recording.torque[-kept.size :], torque)
    load = frame["load_torque"].to_numpy()[changes[1:]]
    np.testing.assert_array_equal(recording.load_torque[-kept.size :], load)


def test_a_load_torque_that_is_read_faster_does_not_count(write):
    frame = joint(rows=ROWS, rate=1000.0)
    changes = np.arange(0, ROWS, 15)
    recording = read(write(held(frame, changes, CHANNELS)))
    np.testing.assert_array_equal(recording.time, frame["time"].to_numpy()[changes])


def test_a_log_that_was_not_updated_is_refused(write):
    frame = joint(rows=ROWS).select("time", *CHANNELS)
    frozen = held(frame, np.array([0, 2000]), CHANNELS)
    with pytest.raises(RecordingError, match="3998 of 4000 rows repeat the row before"):
        read(write(frozen))


def test_a_rest_that_lasts_longer_is_kept(write):
    frame = joint(rows=ROWS, rate=300.0).select("time", *CHANNELS)
    table = {name: frame[name].to_numpy().copy() for name in frame.columns}
    table["velocity"][:600] = 0.0
    for name in ("position", "torque"):
        table[name][:600] = table[name][600]
    changes = np.unique(np.r_[0:600, np.arange(600, ROWS, 3)])
    recording = read(write(held(pl.DataFrame(table), changes, CHANNELS)))
    np.testing.assert_array_equal(recording.time, frame["time"].to_numpy()[changes])


def test_a_row_of_several_joints_repeats_as_a_whole(write):
    """A joint whose values are equal by chance moves with the others; each has the same samples."""
    one = joint(rows=ROWS).select("time", *CHANNELS)
    two = joint(rows=ROWS, seed=2)
    frame = one.rename({c: f"{c}_1" for c in CHANNELS})
    frame = frame.with_columns(**{f"{c}_2": two[c] for c in CHANNELS})
    chance = np.delete(np.arange(ROWS), [700, 1900])
    lost = np.delete(np.arange(ROWS), [1200])
    frame = held(frame, chance, tuple(f"{c}_1" for c in CHANNELS))
    frame = held(frame, lost, tuple(f"{c}_{k}" for c in CHANNELS for k in (1, 2)))
    # Of a third joint nothing was measured.
    nothing = pl.Series(["none"] * ROWS)
    path = write(frame.with_columns(position_3=nothing, torque_3=nothing))
    for number in ("1", "2"):
        recording = read(path, joint=number)
        assert any(note.startswith("1 of 4000 rows repeats the row") for note in recording.notes)
        np.testing.assert_array_equal(recording.time, frame["time"].to_numpy()[lost])
