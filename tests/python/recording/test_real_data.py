"""Public measurements, when they are beside the project."""

from __future__ import annotations

import json

import numpy as np
import pytest
from stribeck.base.errors import RecordingError
from stribeck.recording.load import read
from stribeck.recording.whole_file.scan import scan

from .conftest import CASES, DATA, SIDECARS

real = pytest.mark.skipif(
    not DATA.is_dir(), reason="the public data sets are not at ../shared/data"
)
cases = pytest.mark.skipif(not CASES.is_dir(), reason="the shared cases are not at ../shared/cases")


@real
def test_emps_gives_the_published_parameters():
    recording = read(DATA / "emps" / "emps.parquet", sidecar=SIDECARS / "emps.sidecar.toml")
    assert (recording.joint_kind, recording.torque_unit, len(recording)) == (
        "prismatic",
        "N",
        24841,
    )
    moving = recording.moving
    v = recording.velocity
    regressors = np.stack([recording.acceleration, v, np.sign(v), np.ones_like(v)], axis=1)[moving]
    mass, viscous, coulomb, offset = np.linalg.lstsq(
        regressors, recording.torque[moving], rcond=None
    )[0]
    assert mass == pytest.approx(95.1, rel=0.02)
    assert viscous == pytest.approx(203.5, rel=0.02)
    assert coulomb == pytest.approx(20.4, rel=0.02)
    assert offset == pytest.approx(-3.2, rel=0.05)


@real
def test_emps_without_a_sidecar():
    recording = read(DATA / "emps" / "emps.parquet")
    assert recording.columns["torque"].source == "force_N" and recording.joint_kind == "prismatic"
    assert read(DATA / "emps" / "emps_pulses.parquet").rows == 24841


@real
@pytest.mark.parametrize("j", range(1, 7))
def test_ur10e(j):
    path = DATA / "ur10e" / f"ur-20_01_22-joint_{j}.parquet"
    with pytest.raises(RecordingError, match="6 joints side by side"):
        read(path)
    recording = read(path, sidecar=SIDECARS / f"ur10e_joint_{j}.sidecar.toml")
    assert recording.torque_unit == "N m" and recording.gaps == 0
    assert recording.rate_hz == pytest.approx(100.0) and recording.scored()["share"] > 0.7


@real
def test_bam():
    path = DATA / "bam_xl330" / "xl330_pendulum.parquet"
    with pytest.raises(RecordingError, match="no torque column"):
        read(path)
    recording = read(path, sidecar=SIDECARS / "bam_xl330.sidecar.toml")
    assert recording.torque_unit == "V" and recording.runs == 16 and recording.block_count == 16
    assert len(recording) == 14910 and recording.temperature is not None
    assert 0.3 < recording.scored()["share"] < 0.8


@real
@pytest.mark.parametrize(("drive", "runs"), [(1, 32), (2, 30), (3, 46)])
def test_screw_drives(drive, runs):
    path = DATA / "screwdrives" / "screwdrives.parquet"
    recording = read(path, sidecar=SIDECARS / f"screwdrives_drive_{drive}.sidecar.toml")
    assert recording.averaged and recording.rows == runs == recording.block_count
    assert recording.moving.all() and np.abs(recording.torque).max() < 0.01
    assert recording.joint == str(drive)
    by_flags = read(
        path,
        joint=str(drive),
        where="test=='steady_state'",
        average="run",
        map=("run=file", "joint=drive"),
    )
    np.testing.assert_array_equal(by_flags.torque, recording.torque)
    assert scan(path, map=("run=file", "joint=drive")).joints == ("1", "2", "3")


@cases
def test_moving_rows_of_the_cases():
    truth = json.loads((CASES / "truth.json").read_text())
    for name, said in truth.items():
        recording = read(CASES / f"{name}.parquet")
        assert recording.rate_hz == pytest.approx(said["rate_hz"])
        assert 5e-4 < recording.velocity_noise < 3e-3
        assert recording.scored()["share"] > 0.8
        # The smooth velocity is the derivative of the position to well below the noise.
        slope = np.gradient(recording.position, recording.time)
        error = np.std((recording.velocity_smooth - slope)[50:-50])
        assert error < recording.velocity_noise


@real
@pytest.mark.parametrize("joint", [str(j) for j in range(1, 7)])
@pytest.mark.parametrize("name", ["kr300/A.mat", "ur10e_robot/u8.parquet"])
def test_robots_need_the_joint_and_the_gain_alone(name, joint):
    known = {"torque_constant": 10.0} if name.startswith("ur10e") else {}
    recording = read(DATA / name, joint=joint, **known)
    assert recording.rows > 2000 and recording.gaps == 0
    assert all(recording.columns[c].source.endswith(f"_{joint}") for c in ("position", "torque"))
