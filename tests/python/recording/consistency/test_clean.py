"""No recording that is as it should be is refused or mended."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import stribeck as sb
from stribeck.benchmark.cases import cases
from stribeck.effect.describe import base_of
from stribeck.models.catalog import effect_ids
from stribeck.motion.generate.files import write_robot
from stribeck.motion.generate.hidden import generate
from stribeck.motion.generate.ur5e import RobotRecording

from ..conftest import CASES, DATA, ROOT, SIDECARS

GAINS = (10.0, 10.6956, 8.4566, 9.0029, 9.48, 10.1232)
real = pytest.mark.skipif(
    not DATA.is_dir(), reason="the public data sets are not at ../shared/data"
)


def _alarms(name: str, recording: sb.Recording) -> list[str]:
    """What is refused or mended of a recording."""
    wrong = [f"{name}: {check.said}" for check in recording.checks if not check.ok]
    mended = ("left out (first", "unwrapped", "too many to leave out", "time stamp of")
    return wrong + [
        f"{name}: {note}" for note in recording.notes if any(word in note for word in mended)
    ]


def _measured() -> Iterator[tuple[str, sb.Recording]]:
    for sidecar in sorted(SIDECARS.glob("*.toml")):
        name = sidecar.name.removesuffix(".sidecar.toml")
        file = {
            "emps": "emps/emps.parquet",
            "emps_pulses": "emps/emps_pulses.parquet",
            "bam_xl330": "bam_xl330/xl330_pendulum.parquet",
            "bam_xl330_voltage": "bam_xl330/xl330_pendulum.parquet",
        }.get(name)
        if name.startswith("screwdrives"):
            file = "screwdrives/screwdrives.parquet"
        elif name.startswith("ur10e"):
            file = f"ur10e/ur-20_01_22-joint_{name[-1]}.parquet"
        assert file is not None, name
        yield name, sb.read(DATA / file, sidecar=sidecar)
    for robot in ("l14", "u8", "u12", "u14"):
        for j, gain in enumerate(GAINS, start=1):
            path = DATA / "ur10e_robot" / f"{robot}.parquet"
            yield f"{robot} {j}", sb.read(path, joint=str(j), torque_constant=gain)
    for letter in "ABC":
        for j in range(1, 7):
            yield f"{letter} {j}", sb.read(DATA / "kr300" / f"{letter}.mat", joint=str(j))


@pytest.mark.slow
@real
def test_public_measurements() -> None:
    count, alarms = 0, []
    for name, recording in _measured():
        count += 1
        alarms += _alarms(name, recording)
    assert count == 55 and alarms == []


@pytest.mark.skipif(not CASES.is_dir(), reason="the shared cases are not at ../shared/cases")
def test_shared_cases() -> None:
    files = sorted(CASES.glob("*.parquet"))
    assert len(files) == 9
    assert [a for file in files for a in _alarms(file.name, sb.read(file))] == []


def test_generated_joints(tmp_path: Path) -> None:
    alarms, path = [], tmp_path / "joint.parquet"
    for kind in ("revolute", "prismatic"):
        for hidden in ([], *([*base_of(effect), effect] for effect in effect_ids())):
            frame, _ = generate(hidden, seconds=40.0, rate=100.0, seed=7, joint_kind=kind)
            frame.write_parquet(path)
            alarms += _alarms(f"{kind} {hidden}", sb.read(path, joint_kind=kind))
    assert alarms == []


@pytest.mark.parametrize("test", [1, 2])
def test_a_generated_robot(tmp_path: Path, test: int) -> None:
    robot, path = RobotRecording(test=test, repeats=1, rate=100.0), tmp_path / "robot.parquet"
    write_robot(robot, path)
    Path(f"{path}.sidecar.toml").write_text(robot.sidecar_text())
    joints = robot.truth()["joints"]
    assert [a for name in joints for a in _alarms(name, sb.read(path, joint=name))] == []


@pytest.mark.long
def test_the_generators_of_the_benchmark(tmp_path: Path) -> None:
    alarms, count, path = [], 0, tmp_path / "case.parquet"
    for case in cases(1):
        if case.correlation is None:
            sample = case.make()
            sample.frame.write_parquet(path)
            alarms += _alarms(case.name, sb.read(path, joint_kind="revolute"))
            count += 1
    assert count > 100 and alarms == []


@pytest.mark.slow
def test_the_recordings_with_hidden_effects(tmp_path: Path) -> None:
    sys.path.insert(0, str(ROOT / "tests" / "hidden"))
    import cases as hidden

    alarms, path = [], tmp_path / "case.parquet"
    for case in hidden.cases(1):
        frame, _ = case.make()
        frame.write_parquet(path)
        alarms += _alarms(case.name, sb.read(path, joint_kind="revolute"))
    assert alarms == []
