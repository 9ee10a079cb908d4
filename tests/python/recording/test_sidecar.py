"""A sidecar says what flags say; flags win; mistakes name their line."""

from __future__ import annotations

import numpy as np
import pytest
from stribeck.errors import RecordingError
from stribeck.recording import read

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
        ('kind = "recording"\nkm = ?\n', "is not TOML.*line 2"),
        ('kind = "recording"\njoint_kind = "screwed"', "joint_kind screwed: unknown kind of joint"),
        ('kind = "recording"\naverage = "joint"', "--average joint: only 'run'"),
    ],
)  # fmt: skip
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
