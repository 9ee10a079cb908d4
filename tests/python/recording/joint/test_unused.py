"""Numbers that change nothing are said."""

from __future__ import annotations

import polars as pl
import pytest
from stribeck.recording.load import read

from ..conftest import joint


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = tmp_path_factory.mktemp("unused") / "joint.csv"
    joint(rows=2000).write_csv(made)
    return made


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"torque_constant": 0.4}, "torque constant 0.4 is not used: the torque is read from"),
        ({"gear_ratio": 100.0}, "gear ratio 100 does not change the torque"),
        ({"screw_pitch": 0.01}, "screw pitch 0.01 m is not used: the joint is revolute"),
        ({"inertia": 2.0}, "not used: inertia 2; the load torque is read from"),
    ],
)
def test_a_number_without_use_is_said(path, given, said):
    plain, told = read(path).notes, read(path, **given).notes
    (more,) = [note for note in told if note not in plain]
    assert said in more


def test_numbers_in_use_are_not(path):
    frame = pl.read_csv(path)
    current = frame.with_columns(current=pl.col("torque") / 40.0).drop("torque", "load_torque")
    used = path.parent / "current.csv"
    current.write_csv(used)
    options = {"torque_constant": 0.4, "gear_ratio": 100.0, "inertia": 2.0}
    assert not [note for note in read(used, **options).notes if "not used" in note]
    at_motor = read(path, gear_ratio=100.0, torque_at="motor").notes
    assert not [note for note in at_motor if "does not change" in note]
