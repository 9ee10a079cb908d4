"""A sidecar says what flags say; flags win; mistakes name their line."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read, read_all

GOOD = """kind = "recording"
joint_kind = "revolute"
inertia = 0.5
gravity_cos = 3.0
km = 0.12
where = "time < 9"

[map]
torque = "measured"

[units]
velocity = "rpm"

[derive]
measured = "raw * 2"
"""


@pytest.fixture
def path(write, frame):
    return write(
        frame.drop("load_torque").with_columns((frame["torque"] / 2).alias("raw")).drop("torque"),
        "d.parquet",
    )


def test_beside_the_file(path, frame):
    path.with_name("d.parquet.sidecar.toml").write_text(GOOD)
    recording = read(path)
    assert len(recording) == 1800 and recording.motor == {"km": 0.12}
    np.testing.assert_allclose(recording.torque, frame["torque"].to_numpy()[:1800])
    np.testing.assert_allclose(recording.load_torque, frame["load_torque"].to_numpy()[:1800])
    np.testing.assert_allclose(recording.velocity, frame["velocity"].to_numpy()[:1800] * np.pi / 30)
    flags = read(path, unit=("velocity=rad/s",), inertia=0.0, where="time < 5")
    assert len(flags) == 1000
    np.testing.assert_allclose(flags.velocity, frame["velocity"].to_numpy()[:1000])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('kind = "recording"\n\ngear_ration = 3', r"line 3: unknown key 'gear_ration'; did you"),
        ('kind = "recording"\n[maps]\nq = "x"', r"line 2: unknown key 'maps'; did you"),
        ('kind = "model"', "line 1: kind is 'model'"),
        ("joint_kind = 'revolute'", "line 1: there is no kind"),
        ('kind = "recording"\ninertia = "big"', "line 2: inertia must be a finite number"),
        ('kind = "recording"\ninertia = nan', "line 2: inertia must be a finite number"),
        ('kind = "recording"\ntorque_constant = -1', "line 2: torque_constant must be above zero"),
        ('kind = "recording"\nwhere = 3', "line 2: where must be a text"),
        ('kind = "recording"\n[map]\n\ntorque = 3', "line 4: map.torque must be a text"),
        ('kind = "recording"\nmap = 3', r"line 2: map must be a table: write \[map\]"),
        ('kind = "recording"\nkm = ?\n', "not a TOML file.*line 2"),
        ('kind = "recording"\njoint_kind = "screwed"', "joint_kind screwed: unknown kind of joint"),
        ('kind = "recording"\naverage = "joint"', "average joint: unknown value; give run or row"),
    ],
)
def test_mistakes(path, tmp_path, text, sentence):
    sidecar = tmp_path / "s.toml"
    sidecar.write_text(text)
    with pytest.raises(RecordingError, match=sentence):
        read(path, sidecar=sidecar)


def test_missing(path, tmp_path):
    with pytest.raises(RecordingError, match=r"no such sidecar"):
        read(path, sidecar=tmp_path / "none.toml")


def test_screw(write, frame, tmp_path):
    sidecar = tmp_path / "s.toml"
    sidecar.write_text('kind = "recording"\njoint_kind = "prismatic"\nscrew_pitch = 0.01\n')
    table = frame.drop("load_torque").rename(
        {
            "velocity": "v_radps",
            "position": "q_rad",
            "acceleration": "a_radps2",
            "torque": "torque_Nm",
        }
    )
    recording = read(write(table), sidecar=sidecar)
    per_rad = 0.01 / (2 * np.pi)
    assert (recording.joint_kind, recording.torque_unit) == ("prismatic", "N")
    np.testing.assert_allclose(recording.velocity, frame["velocity"].to_numpy() * per_rad)
    np.testing.assert_allclose(recording.torque, frame["torque"].to_numpy() / per_rad)


def test_a_motor_before_a_screw_gives_a_force(write, frame):
    """Positions in m, torque in N m: the Gantry's eq 3, by a flag alone."""
    table = frame.drop("load_torque").rename({"position": "q_m", "torque": "torque_Nm"})
    recording = read(write(table), screw_pitch=6.41e-3)
    assert (recording.joint_kind, recording.torque_unit) == ("prismatic", "N")
    expected = frame["torque"].to_numpy() * 2 * np.pi / 6.41e-3
    np.testing.assert_allclose(recording.torque, expected)
    np.testing.assert_allclose(recording.position, frame["position"].to_numpy())


def test_a_current_before_a_screw_gives_a_force(write, frame):
    table = frame.drop("load_torque").rename({"position": "q_m", "torque": "current_A"})
    recording = read(write(table), screw_pitch=0.01, torque_constant=0.05, gear_ratio=3.0)
    expected = frame["torque"].to_numpy() * 0.05 * 3.0 * 2 * np.pi / 0.01
    np.testing.assert_allclose(recording.torque, expected)


def test_power_of_the_motor_gives_a_force(write, frame):
    """The Gantry's section 3: yield times voltage times current is force times speed."""
    table = frame.drop("load_torque").filter(pl.col("velocity").abs() > 0.05)
    power = table["torque"] * table["velocity"] / (0.74 * 0.78)
    table = table.drop("torque").with_columns(voltage_V=pl.lit(220.0), current_A=power / 220.0)
    recording = read(
        write(table.rename({"position": "q_m", "velocity": "v_mps"})),
        derive=["force_N=0.74*0.78*voltage_V*current_A/v_mps"],
        map=["torque=force_N", "current=none"],
    )
    assert recording.torque_unit == "N"
    kept = frame.filter(pl.col("velocity").abs() > 0.05)
    np.testing.assert_allclose(recording.torque, kept["torque"].to_numpy())


@pytest.fixture
def two_joints(write, frame):
    """Two joints of a file that differ in their motors, recorded as currents."""
    one = frame.drop("torque").with_columns(current=frame["torque"] / 6.0)
    both = [one.with_columns(joint=pl.lit(name)) for name in ("large", "small")]
    return write(pl.concat(both), "arm.parquet")


def test_each_joint_has_its_own_numbers(two_joints, frame):
    two_joints.with_name("arm.parquet.sidecar.toml").write_text(
        'kind = "recording"\ngear_ratio = 50.0\n'
        "[joints.large]\ntorque_constant = 0.12\nkm = 0.2\n"
        "[joints.small]\ntorque_constant = 0.06\ngear_ratio = 100.0\n"
    )
    large, small = read_all(two_joints)
    np.testing.assert_allclose(large.torque, frame["torque"].to_numpy(), rtol=1e-12)
    np.testing.assert_allclose(small.torque, frame["torque"].to_numpy(), rtol=1e-12)
    assert large.motor == {"km": 0.2, "gear_ratio": 50.0, "torque_constant": 0.12}
    assert small.motor == {"gear_ratio": 100.0, "torque_constant": 0.06}
    flagged = read(two_joints, joint="small", km=0.3, torque_constant=0.12)
    assert flagged.motor["km"] == 0.3
    np.testing.assert_allclose(flagged.torque, 2.0 * frame["torque"].to_numpy(), rtol=1e-12)


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ("[joints.larg]\nkm = 1.0", "has no such joint; did you mean 'large'"),
        ("[joints.large]\nkmm = 1.0", "line 3: unknown key 'kmm' of joint 'large'; did you"),
        ("[joints.large]\n\nkm = -1.0", "line 4: km must be above zero"),
        ("[joints]\nlarge = 3", "line 3: joints.large must be a table"),
        ("joints = 3", "line 2: joints must be tables"),
    ],
)
def test_mistakes_of_one_joint_name_their_line(two_joints, table, sentence):
    two_joints.with_name("arm.parquet.sidecar.toml").write_text(f'kind = "recording"\n{table}\n')
    with pytest.raises(RecordingError, match=sentence):
        read(two_joints, joint="large", torque_constant=0.1)
