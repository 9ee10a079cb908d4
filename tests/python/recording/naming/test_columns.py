"""Columns are found by name, units by suffix, and nothing ambiguous is picked silently."""

from __future__ import annotations

import math
import warnings

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import RecordingError
from stribeck.base.units import parse_unit
from stribeck.recording.load import read, read_all
from stribeck.recording.naming.columns import parse_name
from stribeck.recording.whole_file.scan import scan


@pytest.mark.parametrize(
    ("name", "channel", "unit", "index"),
    [
        ("time", "time", None, None),
        ("t_s", "time", "s", None),
        ("Timestamp_ms", "time", "ms", None),
        ("q_m", "position", "m", None),
        ("q_rad_3", "position", "rad", "3"),
        ("q_3_deg", "position", "deg", "3"),
        ("q1", "position", None, "1"),
        ("velocity [rad/s]", "velocity", "rad/s", None),
        ("Velocity (deg/s)", "velocity", "deg/s", None),
        ("qd_radps", "velocity", "rad/s", None),
        ("VEL_RPM", "velocity", "rpm", None),
        ("v_mps", "velocity", "m/s", None),
        ("speed_mm_per_s", "velocity", "mm/s", None),
        ("velocity_deg_s", "velocity", "deg/s", None),
        ("qd3_deg_s", "velocity", "deg/s", "3"),
        ("v_m_s", "velocity", "m/s", None),
        ("time_ms", "time", "ms", None),
        ("acc_radps2", "acceleration", "rad/s2", None),
        ("torque_mNm", "torque", "mNm", None),
        ("tau_m", "torque", None, None),
        ("torque_N_m", "torque", "N m", None),
        ("force_N", "torque", "N", None),
        ("effort_V", "torque", "V", None),
        ("torque_pct", "torque", "%", None),
        ("i_A_2", "current", "A", "2"),
        ("temp_C", "temperature", "degC", None),
        ("temperature_degC", "temperature", "degC", None),
        ("load_torque_Nm", "load_torque", "N m", None),
        ("position_j1", "position", None, "1"),
        ("j2_velocity", "velocity", None, "2"),
        ("axis_3_current_A", "current", "A", "3"),
        ("Joint4.torque_Nm", "torque", "N m", "4"),
        ("velocity_j1_deg_s", "velocity", "deg/s", "1"),
        ("adj_1_pos", None, None, None),
        ("q_ref_m", "reference_position", "m", None),
        ("q_goal_rad", None, None, None),
        ("i_des_A_3", None, None, None),
        ("tau_des_Nm_1", None, None, None),
        ("file", None, None, None),
        ("kp", None, None, None),
    ],
)
def test_names(name, channel, unit, index):
    parsed = parse_name(name)
    assert parsed.channel == channel
    assert (parsed.unit.name if parsed.unit else None) == unit
    if channel:
        assert parsed.index == index


@pytest.mark.parametrize(
    ("text", "dimension", "value", "si"),
    [
        ("rpm", "angular velocity", 60.0, 2 * math.pi),
        ("deg", "angle", 180.0, math.pi),
        ("mNm", "torque", 1000.0, 1.0),
        ("N·m", "torque", 2.0, 2.0),
        ("N*m", "torque", 2.0, 2.0),
        ("m/s^2", "linear acceleration", 3.0, 3.0),
        ("ms", "time", 5.0, 0.005),
        ("K", "temperature", 300.0, 26.85),
        ("degF", "temperature", 212.0, 100.0),
        ("permille", "percent", 10.0, 1.0),
    ],
)
def test_units_to_si(text, dimension, value, si):
    unit = parse_unit(text, (dimension,), "x")
    assert value * unit.factor + unit.offset == pytest.approx(si)


def test_suffixes_are_honoured_and_said(write, frame):
    table = frame.select(
        (pl.col("time") * 1e3).alias("t_ms"),
        (pl.col("velocity") * 60 / (2 * math.pi)).alias("vel_rpm"),
        (pl.col("torque") * 1e3).alias("torque_mNm"),
        (pl.col("temperature") + 273.15).alias("temp_K"),
    )
    recording = read(write(table, "d.csv"))
    np.testing.assert_allclose(recording.velocity, frame["velocity"].to_numpy(), rtol=1e-12)
    np.testing.assert_allclose(recording.torque, frame["torque"].to_numpy(), rtol=1e-12)
    np.testing.assert_allclose(recording.temperature, frame["temperature"].to_numpy())
    assert "velocity is read from 'vel_rpm' in rpm, converted to rad/s" in recording.notes
    assert recording.torque_unit == "N m" and recording.joint_kind == "revolute"
    assert recording.columns["velocity"].source == "vel_rpm" and recording.load_torque is None


def test_unit_option_wins(write, frame):
    path = write(frame.with_columns(pl.col("velocity") * 180 / math.pi))
    recording = read(path, unit=("velocity=deg/s",))
    np.testing.assert_allclose(recording.velocity, frame["velocity"].to_numpy(), rtol=1e-12)
    with pytest.raises(
        RecordingError, match=r"unknown unit 'degs'; did you mean 'deg/s'.*Use one of rad/s"
    ):
        read(path, unit=("velocity=degs",))
    with pytest.raises(RecordingError, match=r"'kg' is|unknown unit 'kg'"):
        read(path, unit=("velocity=kg",))
    with pytest.raises(RecordingError, match=r"'N m' is a unit of torque, not of angular velocity"):
        read(path, unit=("velocity=N m",))
    with pytest.raises(RecordingError, match=r"no column 'velocty'; did you mean 'velocity'\?"):
        read(path, unit=("velocty=rpm",))
    with pytest.raises(RecordingError, match=r'write `unit="COLUMN=UNIT"`'):
        read(path, unit=("velocity",))


def _wide(frame):
    columns = {"time": frame["time"]}
    for j in (1, 2, 3):
        columns |= {
            f"q_{j}": frame["position"] * j,
            f"dq_{j}": frame["velocity"] * j,
            f"tau_{j}": frame["torque"] * j,
        }
    return pl.DataFrame(columns)


def test_wide_files_are_refused_with_the_maps(write, frame):
    path = write(_wide(frame))
    sentence = r'3 joints side by side .*`map=\["position=q_1", "velocity=dq_1", "torque=tau_1"\]`'
    for reader in (read, read_all):
        with pytest.raises(RecordingError, match=sentence):
            reader(path)
    with pytest.raises(RecordingError, match=r"name one of 1, 2, 3"):
        read(path, joint="7")
    maps = ("position=q_2", "velocity=dq_2", "torque=tau_2")
    np.testing.assert_array_equal(read(path, map=maps).torque, 2 * frame["torque"].to_numpy())
    np.testing.assert_array_equal(read(path, joint="3").torque, 3 * frame["torque"].to_numpy())
    table = scan(path)
    assert table.wide and table.joints == ("1", "2", "3") and "side by side" in table.problem


def test_map(write, frame):
    path = write(frame.rename({"torque": "measured", "velocity": "w"}))
    np.testing.assert_array_equal(
        read(path, map=("torque=measured", "velocity=w")).torque, frame["torque"].to_numpy()
    )
    with pytest.raises(
        RecordingError, match=r'no torque column; the file has time, .*`map="torque=COLUMN"`'
    ):
        read(path, map=("velocity=w",))
    with pytest.raises(RecordingError, match=r"no column 'mesured'; did you mean 'measured'\?"):
        read(path, map=("torque=mesured",))
    with pytest.raises(RecordingError, match=r"unknown name 'torqe'; did you mean 'torque'\?"):
        read(path, map=("torqe=measured",))
    with pytest.raises(RecordingError, match=r'write `map="NAME=COLUMN"`'):
        read(path, map=("torque",))
    assert read(path, map={"torque": "measured", "temperature": "none"}).temperature is None


def test_samples_at_a_known_rate_need_no_time(write, frame):
    known = read(write(frame))
    path = write(frame.drop("time"), "untimed.csv")
    with pytest.raises(RecordingError, match=r'known rate.*`derive="time=row/1000"`'):
        read(path)
    found = read(path, derive=f"time=row/{known.rate_hz}")
    np.testing.assert_allclose(found.time, known.time - known.time[0], atol=1e-9)
    # A column of this name comes first.
    rows = frame.drop("time").with_columns(row=frame["time"])
    again = read(write(rows, "rows.csv"), derive="time=row")
    np.testing.assert_allclose(again.time, known.time, atol=1e-9)


def test_missing_columns(write, frame):
    with pytest.raises(RecordingError, match=r'no time column.*`map="time=COLUMN"`'):
        read(write(frame.drop("time")))
    with pytest.raises(RecordingError, match=r"neither a velocity nor a position"):
        read(write(frame.drop("velocity", "position")))
    with pytest.raises(RecordingError, match=r"no torque column"):
        read(write(frame.drop("torque")))
    with pytest.raises(RecordingError, match=r"pos, q could each be the position"):
        read(write(frame.with_columns(pl.col("position").alias("q")).rename({"position": "pos"})))


def test_current(write, frame):
    table = (
        frame.drop("load_torque")
        .with_columns((pl.col("torque") / 12.0).alias("i_A"))
        .drop("torque")
    )
    path = write(table)
    with pytest.raises(
        RecordingError, match=r"a current \('i_A'\) but no torque: give option `torque_constant`"
    ):
        read(path)
    recording = read(path, torque_constant=0.12, gear_ratio=100)
    np.testing.assert_allclose(recording.torque, frame["torque"].to_numpy(), rtol=1e-12)
    assert recording.motor == {"gear_ratio": 100.0, "torque_constant": 0.12}
    with pytest.raises(RecordingError, match=r"`torque_constant=-1`: must be above zero"):
        read(path, torque_constant=-1)


def test_derive_and_effort_units(write, frame):
    table = frame.drop("torque", "load_torque").with_columns(
        (pl.col("velocity") * 100).alias("pwm_permille"), pl.lit(7.4).alias("supply_V")
    )
    path = write(table)
    recording = read(path, derive=("torque=pwm_permille/1000*supply_V",))
    assert recording.torque_unit == "V"
    np.testing.assert_allclose(recording.torque, frame["velocity"].to_numpy() * 0.74, rtol=1e-12)
    assert recording.columns["torque"].derived
    scaled = read(path, derive=("torque=35.15*supply_V",))
    assert scaled.torque_unit == "N m"
    assert read(path, derive=("torque=35.15*supply_V",), unit=("torque=%",)).torque_unit == "%"
    with pytest.raises(RecordingError, match=r"unknown column 'pwm'.*position 1"):
        read(path, derive=("torque=pwm/1000",))


def test_joint_kind(write, frame):
    line = frame.select(
        "time",
        pl.col("position").alias("q_m"),
        pl.col("velocity").alias("v_mps"),
        pl.col("torque").alias("force_N"),
    )
    recording = read(write(line))
    assert (recording.joint_kind, recording.torque_unit, recording.position_unit) == (
        "prismatic",
        "N",
        "m",
    )
    assert any("taken as prismatic" in note for note in recording.notes)
    with pytest.raises(RecordingError, match=r"given as revolute"):
        read(write(line), joint_kind="revolute")
    assert "joint kind not given, taken as revolute" in read(write(frame)).notes
    assert read(write(frame), joint_kind="prismatic").torque_unit == "N"
    with pytest.raises(RecordingError, match=r"unknown kind of joint; did you mean 'prismatic'\?"):
        read(write(frame), joint_kind="prismatik")
    mixed = line.with_columns(pl.col("v_mps").alias("v_radps")).drop("v_mps")
    with pytest.raises(RecordingError, match=r"a joint is either prismatic or revolute"):
        read(write(mixed))


def test_load_torque(write, frame):
    bare = write(frame.drop("load_torque"))
    assert read(bare).load_torque is None
    recording = read(bare, inertia=0.5)
    np.testing.assert_allclose(recording.load_torque, 0.5 * frame["acceleration"].to_numpy())
    friction = write(
        frame.drop("torque", "load_torque").with_columns(frame["torque"].alias("friction_torque"))
    )
    direct = read(friction)
    assert not direct.load_torque.any()
    assert any("friction was measured directly" in note for note in direct.notes)
    computed = write(frame.drop("load_torque").with_columns(friction_torque=frame["torque"] - 1.0))
    (note,) = [note for note in read(computed).notes if "in place of the torque" in note]
    assert 'to fit the torque give `map="torque=torque"`' in note
    for maps in ({"torque": "torque"}, {"friction_torque": "none"}):
        measured = read(computed, map=maps)
        np.testing.assert_array_equal(measured.torque, frame["torque"].to_numpy())
        assert measured.load_torque is None


def test_rows_without_a_joint(write, frame):
    with_gaps = pl.concat([frame.with_columns(joint=pl.lit(n)) for n in ("a", None)])
    with pytest.raises(RecordingError, match=r"name one with option `joint` \(a, ''\)"):
        read(write(with_gaps))


def test_several_joints(write, frame):
    two = pl.concat(
        [
            frame.with_columns(joint=pl.lit(n), torque=pl.col("torque") * k)
            for n, k in (("a", 1), ("b", 2))
        ]
    )
    path = write(two)
    with pytest.raises(
        RecordingError, match=r"holds 2 joints: name one with option `joint` \(a, b\)"
    ):
        read(path)
    with pytest.raises(RecordingError, match=r"there is no joint 'c'"):
        read(path, joint="c")
    np.testing.assert_array_equal(read(path, joint="b").torque, 2 * frame["torque"].to_numpy())
    assert [r.joint for r in read_all(path)] == ["a", "b"]
    table = scan(path)
    assert table.joints == ("a", "b") and table.problem is None and table.runs == 2
    assert table.rate_hz == pytest.approx(200.0) and table.gaps == 0
    drive = write(two.rename({"joint": "drive"}), "drive.parquet")
    assert read(drive, map=("joint=drive",), joint="a").joint == "a"


def test_scan(write, frame):
    table = scan(write(frame))
    assert table.rows == 2000 and table.rate_hz == pytest.approx(200.0)
    assert table.channels["velocity"].minimum == pytest.approx(frame["velocity"].min())
    assert [c.name for c in table.columns] == frame.columns
    assert table.channels["velocity"].unit == "rad/s" and table.channels["torque"].unit == "N m"
    with pytest.raises(RecordingError, match="no joint column to find '3' in"):
        read(write(frame), joint="3")
    assert "no torque column" in scan(write(frame.drop("torque"))).problem


@pytest.mark.parametrize("name", ["current_A", "cur_A", "motor_current", "curr_act_A"])
def test_a_current_is_not_read_as_a_torque(name: str) -> None:
    t = np.arange(2000) / 100.0
    frame = pl.DataFrame({"time": t, "velocity": np.sin(t), name: np.sign(np.sin(t))})
    with pytest.raises(sb.RecordingError, match="the name says a current; map it with"):
        sb.read(frame, map=[f"torque={name}"])
    stated = sb.read(frame, map=[f"torque={name}"], unit=[f"{name}=Nm"])
    by_constant = sb.read(frame, torque_constant=2.0)
    assert by_constant.torque == pytest.approx(2.0 * stated.torque)


def test_a_unit_that_contradicts_the_name_of_its_column_is_noted() -> None:
    t = np.arange(2000) / 100.0
    frame = pl.DataFrame({"time": t, "X_mm": np.sin(t), "v_mps": np.cos(t), "force_N": np.cos(t)})
    said = "'X_mm' is read in m, as given, though its name says mm"
    stated = sb.read(frame, map=["position=X_mm"], unit=["X_mm=m"])
    assert [note for note in stated.notes if "its name says" in note] == [said]
    for unit in ([], ["X_mm=mm"], ["v_mps=m/s"], ["X_mm=mm", "force_N=N"]):
        same = sb.read(frame, map=["position=X_mm"], unit=unit, trust=True)
        assert not any("its name says" in note for note in same.notes)


def test_columns_named_by_joint_and_quantity(tmp_path):
    """As ROS logs are: the joint is chosen by the name that its columns begin with."""
    t = np.arange(500) / 100.0
    table = {"time": t}
    for k, joint in enumerate(("torso_lift_joint", "arm_1_joint"), start=1):
        table[f"{joint}_position"] = np.sin(k * t)
        table[f"{joint}_velocity"] = k * np.cos(k * t)
        table[f"{joint}_effort"] = np.sign(np.cos(k * t))
    frame = pl.DataFrame(table)
    with pytest.raises(sb.RecordingError, match="holds 2 joints side by side"):
        sb.read(frame)
    recording = sb.read(frame, joint="arm_1_joint")
    np.testing.assert_array_equal(recording.velocity, table["arm_1_joint_velocity"])
    assert recording.columns["torque"].source == "arm_1_joint_effort"


@pytest.mark.parametrize("names", [("elbow_joint_{}", "wrist_joint_{}"), ("{}_1", "{}_2")])
def test_the_torque_of_another_joint_is_not_taken(names):
    """The only torque of the file is not that of the joint that was named."""
    t = np.arange(500) / 100.0
    table = {"time": t, names[1].format("torque"): np.sign(np.cos(t))}
    for name in names:
        table |= {name.format("position"): np.sin(t), name.format("velocity"): np.cos(t)}
    joints = [name.format("").strip("_") for name in names]
    with pytest.raises(RecordingError, match="there is no torque column"):
        read(pl.DataFrame(table), joint=joints[0])
    assert read(pl.DataFrame(table), joint=joints[1]).rows == 500


def test_a_time_that_is_infinite_is_looked_at_without_a_warning(write, frame):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = scan(write(frame), derive="time=row/0")
    assert found.rate_hz is None


def test_a_unit_in_the_name_that_is_not_known_is_said(write, frame):
    path = write(frame.rename({"torque": "torque (kip ft)"}), "kip.csv")
    known = read(path, map="torque=torque (kip ft)")
    (said,) = [note for note in known.notes if "kip ft" in note and "no unit" in note]
    assert "read in N m" in said and '`unit="torque (kip ft)=UNIT"`' in said
    given = read(path, map="torque=torque (kip ft)", unit="torque (kip ft)=N m")
    assert not any("no unit" in note for note in given.notes)
