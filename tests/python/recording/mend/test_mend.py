"""What is mended, each with a count in the notes, and never a torque changed."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read

from ..conftest import joint


def _said(recording, part):
    found = [note for note in recording.notes if part in note]
    assert len(found) == 1, recording.notes
    return found[0]


def test_one_repeated_time_stamp(write):
    frame = joint(rows=3000)
    twice = pl.concat([frame[:1200], frame[1199:]])
    recording = read(write(twice))
    assert _said(recording, "time stamp").startswith("1 row has the time stamp of the row before")
    assert "row 1201" in _said(recording, "time stamp")
    assert recording.rows == 3000 and recording.gaps == 0
    np.testing.assert_array_equal(recording.torque, frame["torque"].to_numpy())


@pytest.mark.parametrize(
    ("period", "low", "gain"),
    [(2 * np.pi, -np.pi, 9.0), (2 * np.pi, 0.0, 9.0), (25.0, -12.5, 40.0), (1.0, -0.5, 9.0)],
)
def test_a_position_that_wraps_is_unwrapped(write, period, low, gain):
    frame = joint(rows=4000).drop("load_torque")
    q = gain * frame["position"].to_numpy()
    wide = frame.with_columns(
        pl.col("velocity") * gain,
        pl.col("acceleration") * gain,
        position=pl.Series((q - low) % period + low),
    )
    jumps = np.abs(np.diff(wide["position"])) > 0.5 * period
    recording = read(write(wide))
    note = _said(recording, "unwrapped")
    assert f"{int(jumps.sum())} times by" in note
    assert float(note.split(" by ")[1].split(" ")[0]) == pytest.approx(period, rel=2e-2)
    np.testing.assert_allclose(np.diff(recording.position), np.diff(q), atol=0.02 * period)
    assert all(check.ok for check in recording.checks)


def test_a_position_that_wraps_in_degrees_needs_its_unit(write):
    frame = joint(rows=4000).select("time", "torque", angle=pl.col("position"))
    turning = np.rad2deg(2.0 * np.pi * 3.0 * frame["angle"].to_numpy())
    path = write(frame.with_columns(angle=pl.Series(turning % 360.0)))
    with pytest.raises(RecordingError, match=r"jumps [0-9]+ times by 360.*angle=deg"):
        read(path).require_consistent()
    named = read(path, unit={"angle": "deg"})
    assert "by 6.28319 and is unwrapped" in _said(named, "unwrapped")


def test_a_wrap_that_is_not_certain_is_asked_for(write):
    frame = joint(rows=2000).select("time", "position", "torque")
    once = frame.with_columns(
        position=pl.Series(np.where(np.arange(2000) < 997, 0.0, 3.3)) + pl.col("position")
    )
    path = write(once)
    recording = read(path)
    (check,) = [c for c in recording.checks if c.check == "position"]
    assert not check.ok and "`unwrap`" in str(check.do)
    with pytest.raises(RecordingError, match="jumps 1 time by"):
        recording.require_consistent()
    note = _said(read(path, unwrap=True), "unwrapped")
    assert note.startswith("the position jumps 1 time")


def test_rows_without_a_measurement_are_left_out(write):
    frame = joint(rows=3000)
    names = ["position", "velocity", "torque"]
    table = {name: frame[name].to_numpy().copy() for name in frame.columns}
    for name in names:
        table[name][[560, 561, 1700]] = 0.0  # drop-outs
        table[name][[800, 801, 802]] = table[name][799]  # the logger repeats itself
    table["torque"][[2100, 2600]] += [400.0, -500.0]  # spikes
    recording = read(write(pl.DataFrame(table)))
    assert _said(recording, "zeros").startswith("3 of 3000 rows hold zeros")
    assert _said(recording, "repeat").startswith("3 of 2997 rows repeat the row before")
    assert _said(recording, "spikes").startswith("2 of 2994 rows have a torque")
    bad = [560, 561, 800, 801, 802, 1700, 2100, 2600]
    np.testing.assert_array_equal(recording.torque, np.delete(frame["torque"].to_numpy(), bad))
    # As where so few rows were never written.
    assert recording.gaps == 0


def test_a_clipped_torque_is_left_out(write):
    frame = joint(rows=3000)
    limit = 0.97 * float(frame["torque"].max())
    clipped = frame.with_columns(pl.col("torque").clip(upper_bound=limit))
    count = int((clipped["torque"] == limit).sum())
    recording = read(write(clipped))
    assert _said(recording, "clipped").startswith(f"{count} of 3000 rows have a torque")
    assert float(recording.torque.max()) < limit


@pytest.mark.parametrize(("share", "is_left_out"), [(0.7, True), (0.1, False)])
def test_a_torque_that_is_often_clipped_is_left_out_up_to_half(write, share, is_left_out):
    frame = joint(rows=3000)
    limit = share * float(frame["torque"].abs().max())
    clipped = frame.with_columns(pl.col("torque").clip(-limit, limit))
    count = int((clipped["torque"].abs() == limit).sum())
    assert (150 < count < 1500) == is_left_out
    recording = read(write(clipped))
    assert recording.rows == (3000 - count if is_left_out else 3000)
    end = "left out" if is_left_out else "too many to leave out"
    assert end in _said(recording, "clipped")


def test_a_clean_joint_is_left_as_it_is(write):
    frame = joint(rows=3000)
    recording = read(write(frame))
    assert recording.rows == 3000 and not any("left out" in note for note in recording.notes)
    rounded = frame.with_columns(pl.col("position", "velocity", "torque").round(2))
    recording = read(write(rounded))
    assert recording.rows == 3000 and not any("left out" in note for note in recording.notes)


def test_a_joint_at_rest_is_not_stuck(write):
    """Without noise, every row at rest is the row before it."""
    t = np.arange(4000) / 200.0
    v = np.where(t % 4.0 < 2.0, np.sin(np.pi * t), 0.0)
    q = np.cumsum(v) / 200.0
    torque = np.sign(v) + v
    recording = read(
        write(pl.DataFrame({"time": t, "position": q, "velocity": v, "torque": torque}))
    )
    assert recording.rows == 4000


def test_a_streamed_data_set_is_not_mended(tmp_path):
    """Its windows are read one by one: what a part of it would mend, they would not."""
    import stribeck as sb

    frame = joint(rows=4000).drop("load_torque")
    gain = 9.0
    q = gain * frame["position"].to_numpy()
    scaled = frame.with_columns(pl.col("velocity") * gain, pl.col("acceleration") * gain)
    path = tmp_path / "data.parquet"
    scaled.with_columns(position=pl.Series((q + np.pi) % (2 * np.pi) - np.pi)).write_parquet(path)
    with pytest.raises(RecordingError, match="a streamed data set is not unwrapped"):
        sb.stream(path).fit("coulomb", starts=1)
    scaled.with_columns(position=pl.Series(q)).write_parquet(path)
    assert sb.stream(path).fit("coulomb", starts=1).rmse > 0.0
