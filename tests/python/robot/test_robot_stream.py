"""Recordings of a robot that are read in passes: the same results as in memory."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import arms
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import FitError, RecordingError
from stribeck.cli.main import cli
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.drive_gains import KnownPayload
from stribeck.robot.fit import fit_robot
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import read_motion
from stribeck.robot.result import RobotFit
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.urdf import read_urdf
from stribeck.scale.robots import text_parts
from stribeck.scale.robots.stream import RobotStream, stream_robot

MAP = [f"{channel}={column}" for channel, column in COLUMNS]
CUTOFF = 10.0
ROWS, RATE = 3000, 100.0
#: Filters of a window forget what lies beyond its margins to 1e-10; differences grow by the
#: condition of the regressor.
APART = 1e-6


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    path = tmp_path_factory.mktemp("urdf") / "scara.urdf"
    path.write_text(arms.urdf("scara"))
    return read_urdf(path)


@pytest.fixture(scope="module")
def runs(arm: Robot, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Two runs, the second with a payload."""
    folder = tmp_path_factory.mktemp("runs")
    friction = {
        name: sb.model("coulomb", coulomb_friction=3.0 + k, viscous_friction=2.0)
        for k, name in enumerate(arm.names)
    }
    # In the first joint it grows with the load, so that all parameters of `load` are determined.
    law = friction[arm.names[0]].with_effect("load", {"reference_load": 10.0})
    values = {"coulomb_friction": 3.0, "viscous_friction": 2.0, "load_coulomb": 1.0}
    values["load_exponent"] = 1.0
    friction[arm.names[0]] = law.with_values([values.get(name, 0.0) for name in law.names])
    parameters = np.array([[*joint.inertial, joint.rotor] for joint in arm.joints])
    parameters[-1, :10] += np.array([1.5, 0.0, 0.0, 0.15, 0.02, 0.0, 0.02, 0.0, 0.0, 0.01])
    made = []
    for seed, robot in ((1, arm), (2, arm.with_bodies(parameters))):
        made.append(str(folder / f"run_{seed}.parquet"))
        simulate_robot(
            robot, friction, seconds=ROWS / RATE, rate=RATE, noise=0.01, seed=seed
        ).write_parquet(made[-1])
    return made


def opened(arm: Robot, files: list[str], **options: int) -> RobotStream:
    """Windows are short, so that a pass has several."""
    found = stream_robot(arm, files, cutoff=CUTOFF, map=MAP, **options)
    found.data.window_rows = 700
    return found


def in_memory(arm: Robot, files: list[str], spec: str, payload: tuple[str, ...] = ()) -> RobotFit:
    motion = read_motion(arm, files, ReadOptions(map=MAP), CUTOFF)
    return fit_robot(motion, spec, payload=payload)


def numbers(found: RobotFit) -> dict[str, np.ndarray]:
    """What a fit says, as arrays."""
    rows = [estimate for joint in found.joints for estimate in joint.estimates.values()]
    return {
        "base": np.array([row.value for row in found.base_parameters]),
        "friction": np.array([row.value for row in rows]),
        "errors": np.array([0.0 if row.stderr is None else row.stderr for row in rows]),
        "rmse": np.array([(joint.rmse, joint.rmse_held_out) for joint in found.joints]),
        "relative": np.array([joint.relative_residual_held_out for joint in found.joints]),
        "ordinary": np.array([joint.relative_residual for joint in found.ordinary]),
    }


def assert_alike(found: RobotFit, expected: RobotFit, apart: float = APART) -> None:
    for name, values in numbers(expected).items():
        size = np.abs(values).max()
        np.testing.assert_allclose(numbers(found)[name], values, rtol=0, atol=apart * size)


def test_passes_give_what_memory_gives(arm: Robot, runs: list[str]) -> None:
    stream = opened(arm, runs[:1])
    found = fit_robot(stream)
    assert_alike(found, in_memory(arm, runs[:1], "coulomb+offset"))
    assert stream.data.passes == 2


@pytest.mark.slow
def test_coupled_motors_and_drive_gains_in_passes(arm: Robot, runs: list[str]) -> None:
    """The second run's payload is taken as known; the last motor turns with the joint before."""
    coupled = replace(arm, coupling=coupling_of(len(arm.names)))
    found, expected = (
        fit_robot(data, payload=["run_2"], known_payload=KnownPayload(1.5, (0.0, 0.0, 0.1)))
        for data in (
            opened(coupled, runs),
            read_motion(coupled, runs, ReadOptions(map=MAP), CUTOFF),
        )
    )
    assert_alike(found, expected)
    ratios = [
        [np.nan if gain.ratio is None else gain.ratio for gain in fit.drive_gains]
        for fit in (found, expected)
    ]
    np.testing.assert_allclose(ratios[0], ratios[1], rtol=1e-5)
    assert np.isfinite(ratios[0]).any()


def coupling_of(count: int) -> tuple[tuple[float, ...], ...]:
    """Each motor turns its joint, and the last one with the joint before it."""
    matrix = np.eye(count)
    matrix[-1, -2] = 0.5
    return tuple(map(tuple, matrix.tolist()))


def test_a_law_that_reads_the_load_takes_more_passes(arm: Robot, runs: list[str]) -> None:
    stream, laws = opened(arm, runs[:1]), {arm.names[0]: "coulomb+load+offset"}
    found = fit_robot(stream, of_joints=laws)
    motion = read_motion(arm, runs[:1], ReadOptions(map=MAP), CUTOFF)
    # Both searches end where a step no longer matters, not at the same bits.
    assert_alike(found, fit_robot(motion, of_joints=laws), 1e-3)
    assert stream.data.passes > 3


@pytest.mark.slow
def test_files_are_runs_and_a_payload_is_found(arm: Robot, runs: list[str]) -> None:
    spec, payload = "coulomb+offset", ("run_2",)
    found = fit_robot(opened(arm, runs), spec, payload=payload)
    expected = in_memory(arm, runs, spec, payload)
    assert_alike(found, expected)
    assert found.payload is not None and expected.payload is not None
    assert found.payload.mass == pytest.approx(expected.payload.mass, rel=APART)
    assert found.solved.balance.run_names == ("run_1", "run_2")
    assert fit_robot(opened(arm, runs)).solved.balance.held_out == "runs"


def test_currents_become_torques(arm: Robot, runs: list[str], tmp_path: Path) -> None:
    gains = {name: 2.0 + k for k, name in enumerate(arm.names)}
    driven = replace(
        arm, joints=tuple(replace(joint, drive_gain=gains[joint.name]) for joint in arm.joints)
    )
    frame = pl.read_parquet(runs[0])
    effort = dict(COLUMNS)["torque"]
    for name, gain in gains.items():
        column = effort.format(joint=name)
        frame = frame.with_columns((pl.col(column) / gain).alias(f"i_{name}")).drop(column)
    path = str(tmp_path / "run_1.parquet")
    frame.write_parquet(path)
    mapped = [pair for pair in MAP if not pair.startswith("torque=")] + ["current=i_{joint}"]
    stream = stream_robot(driven, [path], cutoff=CUTOFF, map=mapped)
    assert_alike(fit_robot(stream), in_memory(arm, runs[:1], "coulomb+offset"))


@pytest.mark.slow
def test_a_part_in_memory_is_enough(arm: Robot, runs: list[str]) -> None:
    stream = opened(arm, runs[:1], sample_rows=1000)
    assert stream.motion.rows == 1000
    found, expected = fit_robot(stream), in_memory(arm, runs[:1], "coulomb+offset")
    assert found.solved.balance.rows == ROWS
    # Which samples move follows from the noise in the part.
    assert_alike(found, expected, 1e-2)


@pytest.mark.slow
def test_text_is_read_as_parquet_is(
    arm: Robot, runs: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_parts, "PIECE", 100_000)
    path = tmp_path / "run_1.csv"
    pl.read_parquet(runs[0]).write_csv(path)
    stream = opened(arm, [str(path)])
    assert len(stream.data.data.files) > 3
    assert stream.data.data.place(ROWS - 1) == f"row {ROWS} of run_1.csv"
    assert_alike(fit_robot(stream), fit_robot(opened(arm, runs[:1])), 1e-9)


def test_columns_of_whole_numbers_may_become_fractions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_parts, "PIECE", 64)
    path = tmp_path / "log.csv"
    path.write_text("t;i\n" + "".join(f"{k};{k if k < 50 else 0.5}\n" for k in range(100)))
    made = text_parts.text_parts(str(path), text_parts.Asked(), tmp_path)
    table = pl.concat([pl.read_parquet(part) for part in made])
    assert len(made) > 3 and table.shape == (100, 2)
    assert table["i"].to_list() == [float(k) if k < 50 else 0.5 for k in range(100)]
    path.write_text("t;i\n" + "1;2\n" * 50 + "1;word\n")
    with pytest.raises(RecordingError, match="later rows have other columns, or text"):
        text_parts.text_parts(str(path), text_parts.Asked(), tmp_path)


@pytest.mark.slow
def test_what_cannot_be_read_in_passes_is_refused(
    arm: Robot, runs: list[str], tmp_path: Path
) -> None:
    other = tmp_path / "log.npz"
    np.savez(other, t=np.arange(10.0))
    with pytest.raises(RecordingError, match=r"only Parquet, CSV and TSV files are read in passes"):
        opened(arm, [str(other)])
    copied = shutil.copy(runs[1], tmp_path)
    Path(f"{copied}.sidecar.toml").write_text('kind = "recording"\ntorque_constant = 2.0\n')
    with pytest.raises(RecordingError, match="its sidecar says something else than that of"):
        opened(arm, [runs[0], copied])
    with pytest.raises(RecordingError, match="weights need all samples in memory"):
        stream_robot(arm, runs[:1], map=MAP, weights="1")
    with pytest.raises(FitError, match="has no run 'run_9'"):
        fit_robot(opened(arm, runs), payload=("run_9",))
    judged = read_motion(arm, runs[:1], ReadOptions(map=MAP), CUTOFF)
    with pytest.raises(FitError, match="judges nothing"):
        fit_robot(opened(arm, runs), evaluate=[judged])


def test_more_than_the_memory_holds_is_refused(
    arm: Robot, runs: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("stribeck.robot.motion.BYTES", 1e12)
    with pytest.raises(RecordingError, match=r"3000 samples of 4 joints need about .* in passes"):
        read_motion(arm, runs[:1], ReadOptions(map=MAP), CUTOFF)


@pytest.mark.slow
def test_the_command_reads_in_passes(arm: Robot, runs: list[str], tmp_path: Path) -> None:
    described = tmp_path / "scara.urdf"
    described.write_text(arms.urdf("scara"))
    words = ["--urdf", str(described), "--stream", "--cutoff", "10", "--json"]
    words += [word for pair in MAP for word in ("--map", pair)]
    done = CliRunner().invoke(cli, ["robot", "fit", *runs, *words])
    assert done.exit_code == 0, done.output
    answer = json.loads(done.stdout)
    assert answer["held_out"] == "runs" and answer["converged"]
    done = CliRunner().invoke(
        cli, ["robot", "compare", *runs, "coulomb+offset", "coulomb+offset", *words]
    )
    first, second = json.loads(done.stdout)["models"]
    assert first["joints"] == second["joints"]


@pytest.mark.slow
def test_effects_are_sought_in_the_part_in_memory(arm: Robot, runs: list[str]) -> None:
    found = improve_robot(opened(arm, runs[:1], sample_rows=2000), most_steps=0)
    assert found.final.solved.balance.rows == ROWS
    assert not any(found.steps.values())
    assert set(found.last) == set(arm.names)
