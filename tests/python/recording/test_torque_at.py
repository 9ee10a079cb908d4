"""Where the torque was measured: given, or guessed from the names of its columns."""

from __future__ import annotations

import doctest

import numpy as np
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording import torque_at
from stribeck.recording.load import read

from .conftest import joint


def _said(recording):
    (check,) = [check for check in recording.checks if check.check == "torque_at"]
    assert check.ok
    return check.said


def test_examples():
    assert doctest.testmod(torque_at).failed == 0


@pytest.mark.parametrize(
    ("column", "where"),
    [
        ("tau_des_Nm", "command"),
        ("torque_command", "command"),
        ("motor_torque", "motor"),
        ("MotorTorque", "motor"),
        ("torque_sensor", "link"),
        ("torque", None),
    ],
)
def test_names_say_where(write, column, where):
    path = write(joint().rename({"torque": column}))
    recording = read(path, map=f"torque={column}")
    assert recording.torque_at == where
    said = _said(recording)
    assert ("by its name" in said) == (where is not None)
    assert read(path, map=f"torque={column}", torque_at="link").torque_at == "link"


def test_a_cell_at_the_link_sees_no_gear(write):
    recording = read(write(joint()), torque_at="link")
    assert "does not hold the friction of motor and gear" in _said(recording)
    with pytest.raises(RecordingError, match=r"torque_at=.*give motor or command or link"):
        read(write(joint()), torque_at="gear")


def test_a_current_is_the_motors(write):
    frame = joint().rename({"torque": "current"}).drop("load_torque")
    assert read(write(frame), torque_constant=0.1).torque_at == "motor"


def test_a_motor_torque_is_converted_by_the_gear_ratio_if_both_are_stated(write):
    frame = joint().drop("load_torque")
    path = write(frame)
    made = read(path, torque_at="motor", gear_ratio=50.0)
    np.testing.assert_array_equal(made.torque, frame["torque"].to_numpy() * 50.0)
    assert any("times the gear ratio 50" in note for note in made.notes)
    # A ratio alone is that of the current or of the energy, as before.
    np.testing.assert_array_equal(read(path, gear_ratio=50.0).torque, frame["torque"].to_numpy())


def test_the_sidecar_may_say_it(write):
    path = write(joint())
    path.with_name(f"{path.name}.sidecar.toml").write_text(
        'kind = "recording"\ntorque_at = "link"\nmoving_above = 0.5\n'
    )
    recording = read(path)
    assert recording.torque_at == "link" and recording.velocity_threshold == 0.5
