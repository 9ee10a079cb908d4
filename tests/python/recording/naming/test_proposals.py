"""Names that are understood by a part of them, columns that are proposed, and the sidecar."""

from __future__ import annotations

import doctest
import json

import numpy as np
import polars as pl
import pytest
import scipy
import stribeck as sb
from stribeck.base.errors import RecordingError
from stribeck.cli.flags import with_flags
from stribeck.diagnosis.inspect import inspect, write_proposed
from stribeck.recording.load import read
from stribeck.recording.naming import names, proposals
from stribeck.recording.naming.names import parse_name
from stribeck.recording.stated.options import ReadOptions

from ..conftest import DATA, joint

GAINS = (10.0, 10.6956, 8.4566, 9.0029, 9.48, 10.1232)


def test_examples():
    assert doctest.testmod(names).failed == doctest.testmod(proposals).failed == 0


@pytest.mark.parametrize(
    ("name", "channel", "unit", "index"),
    [
        ("act_pos_mot_deg_3", "position", "deg", "3"),
        ("act_vel_mot_deg_per_s_1", "velocity", "deg/s", "1"),
        ("act_torque_abs_nm_6", "torque", "N m", "6"),
        ("posAct", "position", None, None),
        ("measuredTorque_mNm_2", "torque", "mNm", "2"),
        ("posDes", None, None, None),
        ("time_cont", "time", None, None),
        ("ref_pos_deg_1", None, None, None),
        ("mos_temperature", None, None, None),
        ("Position actual value [deg]", "position", "deg", None),
        ("Torque Actual Value", "torque", None, None),
        ("Target Position (deg)", "reference_position", "deg", None),
    ],
)
def test_words_that_do_not_change_what_is_measured(name, channel, unit, index):
    parsed = parse_name(name)
    assert parsed.channel == channel
    if channel is not None:
        assert (parsed.unit.name if parsed.unit else None) == unit and parsed.index == index


@pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data")
@pytest.mark.parametrize("file", ["A", "B", "C"])
def test_kr300_is_read_by_its_joint_alone(file):
    path = DATA / "kr300" / f"{file}.mat"
    for j in range(1, 7):
        # With trust, since the recorded velocity lags the position by some samples.
        recording = read(path, joint=str(j), trust=True)
        assert recording.columns["position"].source == f"act_pos_mot_deg_{j}"
        assert recording.columns["velocity"].source == f"act_vel_mot_deg_per_s_{j}"
        assert recording.rate_hz == pytest.approx(250.0)
        assert all(check.ok for check in recording.checks)
        assert any("arrays are left out, not 2501 long" in note for note in recording.notes)
    joint = read(path, joint="1", torque_at="motor", gear_ratio=256.857)
    assert np.abs(joint.torque).max() < 2356.0
    proposed = {row.column: row for row in inspect(str(path), joint="1").proposed}
    assert proposed["act_pos_se_deg_1"].channel == "position"


@pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data")
@pytest.mark.parametrize("file", ["l14", "u8", "u12", "u14"])
def test_ur10e_robot_is_read_by_joint_and_gain(file):
    for j, gain in enumerate(GAINS, start=1):
        path = DATA / "ur10e_robot" / f"{file}.parquet"
        recording = read(path, joint=str(j), torque_constant=gain)
        assert recording.torque_at == "motor" and all(check.ok for check in recording.checks)


def test_a_missing_channel_is_proposed_with_what_its_name_says(write):
    frame = joint().select("time", "position", "velocity", "torque")
    renamed = {
        "time": "loop_time",
        "position": "output_angle",
        "velocity": "shaft speed",
        "torque": "output_torque",
    }
    path = write(frame.rename(renamed))
    maps = (
        "time=loop_time",
        "position=output_angle",
        "velocity=shaft speed",
        "torque=output_torque",
    )
    with pytest.raises(RecordingError) as refused:
        read(path)
    given = "--map time=loop_time --map position=output_angle --map 'velocity=shaft speed'"
    said = with_flags(str(refused.value))
    assert f"(by their names perhaps {given} --map torque=output_torque)" in said
    assert read(path, map=maps).velocity.size == frame.height
    # Of two that may be it, neither is proposed.
    two = frame.rename(renamed).with_columns(pl.col("output_angle").alias("input_angle"))
    with pytest.raises(RecordingError, match=r"perhaps `map=\[\"time=loop_time\", \"velocity"):
        read(write(two, "two.csv"))


def test_a_column_that_is_not_known_is_proposed(write):
    frame = joint().rename({"temperature": "mos_temperature"})
    shown = inspect(str(write(frame)))
    assert [(row.column, row.channel) for row in shown.proposed] == [
        ("mos_temperature", "temperature")
    ]
    assert json.loads(json.dumps(shown.to_dict()))["proposed"][0]["channel"] == "temperature"
    note = next(note for note in shown.notes if "mos_temperature" in note)
    assert 'map="temperature=mos_temperature"' in note


def test_the_assumed_units_are_said(write):
    recording = read(write(joint().rename({"velocity": "velocity_rpm"})), trust=True)
    note = next(note for note in recording.notes if note.startswith("units assumed"))
    assert "position in rad" in note and "velocity" not in note


def test_the_proposed_sidecar_reads_the_file(write):
    frame = joint().rename({"temperature": "mos_temperature", "velocity": "dq", "position": "q"})
    frame = frame.with_columns(pl.col("dq") * 30.0 / np.pi, pl.col("q") * 180.0 / np.pi)
    path = write(frame.drop("acceleration", "load_torque"))
    assert not all(check.ok for check in inspect(str(path)).checks)
    made = write_proposed(inspect(str(path)), ReadOptions())
    assert made.name == "data.parquet.sidecar.toml" and "Check every line" in made.read_text()
    recording = sb.read(path)
    assert all(check.ok for check in recording.checks) and recording.temperature is not None
    np.testing.assert_allclose(recording.velocity, joint()["velocity"].to_numpy(), rtol=1e-9)
    before = made.read_text()
    with pytest.raises(RecordingError, match="exists and is not replaced"):
        write_proposed(inspect(str(path)), ReadOptions())
    assert made.read_text() == before


def test_the_proposed_sidecar_keeps_options(write):
    frame = joint().drop("load_torque").rename({"torque": "i_A"})
    path = write(frame)
    options = ReadOptions(torque_constant=0.5, where="time > 1", unit=["i_A=A"], inertia=0.2)
    before = sb.read(path, **options.given())
    write_proposed(inspect(str(path), **options.given()), options)
    after = sb.read(path)
    np.testing.assert_array_equal(before.torque, after.torque)
    assert len(before) == len(after)
    np.testing.assert_array_equal(before.load_torque, after.load_torque)


def test_arrays_of_several_lengths(tmp_path):
    """The arrays with a clock and a motion are taken, and the others are named."""
    frame = joint(rows=500)
    arrays = {name: frame[name].to_numpy() for name in frame.columns}
    long = {"trace": np.arange(9000.0)}
    short = {f"gain_{word}": np.arange(6.0) for word in "abcdefghi"}
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {**arrays, **long, **short})
    recording = read(path)
    assert len(recording) == 500
    (note,) = [note for note in recording.notes if "left out" in note]
    assert note.startswith("10 arrays are left out, not 500 long: trace (9000), gain_a (6)")


def test_fields_of_two_structs_with_one_name(tmp_path):
    frame = joint(rows=500)
    arrays = {name: frame[name].to_numpy() for name in frame.columns}
    other = {"torque": np.arange(500.0), "time": arrays["time"]}
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"rec": arrays, "plan": other})
    np.testing.assert_array_equal(read(path).torque, arrays["torque"])


def test_a_velocity_that_is_not_read_is_named(tmp_path):
    path = tmp_path / "joint.csv"
    joint(rows=2000).rename({"velocity": "velocity_of_the_drum"}).write_csv(path)
    said = [note for note in read(path).notes if "'velocity_of_the_drum' is not read" in note]
    assert len(said) == 1 and "velocity=velocity_of_the_drum" in said[0]
    left_out = read(path, map={"velocity": "none"})
    assert not [note for note in left_out.notes if "is not read" in note]
