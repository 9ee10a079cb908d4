"""Identification of simulated arms: parameters, payload, effects; bad input."""

from __future__ import annotations

from pathlib import Path

import arms
import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import FitError, ModelFileError, RecordingError, SpecError
from stribeck.cli.main import cli
from stribeck.motion.design.motion import Limits, SampledMotion
from stribeck.recording.stated.options import ReadOptions
from stribeck.report.pages.robot import robot_fit_page
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.consistent import inertial_of, pseudo_inertia
from stribeck.robot.describe import read_robot
from stribeck.robot.drive_gains import KnownPayload
from stribeck.robot.fit import fit_robot
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import RobotMotion, read_motion
from stribeck.robot.plan import plan_robot
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.stored import read_friction, write_robot
from stribeck.robot.tables import from_tables
from stribeck.robot.updated_urdf import write_urdf
from stribeck.robot.urdf import read_urdf

MAP = {"map": [f"{channel}={column}" for channel, column in COLUMNS]}


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Robot:
    path = tmp_path_factory.mktemp("urdf") / "scara.urdf"
    path.write_text(arms.urdf("scara"))
    return read_urdf(path)


def friction_of(arm: Robot, loaded: str | None = None) -> dict[str, sb.Model]:
    made = {}
    for k, joint in enumerate(arm.joints):
        values = {"coulomb_friction": 3.0 + k, "viscous_friction": 2.0 + 0.5 * k}
        made[joint.name] = sb.model("coulomb", **values)
        if joint.name == loaded:
            constants = {"reference_load": 10.0}
            law = sb.model("coulomb", **values).with_effect("load", constants)
            own = {"load_coulomb": 0.15, "load_exponent": 1.0}
            made[joint.name] = law.with_values([{**values, **own}.get(n, 0.0) for n in law.names])
    return made


def motion_of(
    robot: Robot,
    friction: dict[str, sb.Model],
    folder: Path,
    seeds: tuple[int, ...],
    **options: float,
) -> RobotMotion:
    files = []
    for seed in seeds:
        path = folder / f"run_{seed}.parquet"
        simulate_robot(robot, friction, seed=seed, **options).write_parquet(path)
        files.append(str(path))
    return read_motion(robot, files, ReadOptions(map=MAP["map"]), 10.0)


def test_parameters_lie_in_their_intervals(arm: Robot, tmp_path: Path) -> None:
    friction = friction_of(arm)
    options = {"seconds": 20.0, "rate": 100.0, "noise": 0.01}
    motion = motion_of(arm, friction, tmp_path, (1, 2), **options)
    assert len(repr(motion)) < 300 and f"{motion.rows} samples of" in repr(motion)
    found = fit_robot(motion)
    true = np.array([[*joint.inertial, joint.rotor] for joint in arm.joints]).ravel()
    base = BaseParameters.of(arm)
    expected = base.mapping @ true
    errors = np.array([row.stderr for row in found.base_parameters])
    values = np.array([row.value for row in found.base_parameters])
    assert np.mean(np.abs(values - expected) < 3.0 * errors) > 0.9
    for joint in found.joints:
        assert joint.relative_residual_held_out < 0.01
        dry = joint.estimates["coulomb_friction"]
        value = friction[joint.joint].value("coulomb_friction")
        assert abs(dry.value - value) < max(4.0 * dry.stderr, 0.01 * value)
    assert found.consistent
    for row in found.bodies.parameters:
        assert np.linalg.eigvalsh(pseudo_inertia(row[:10])).min() > 0.0


def test_payload_mass_lies_in_its_interval(arm: Robot, tmp_path: Path) -> None:
    options = {"seconds": 15.0, "rate": 100.0, "noise": 0.01}
    first = motion_of(arm, friction_of(arm), tmp_path, (1,), **options)
    last = arm.joints[-1]
    parameters = np.array([[*joint.inertial, joint.rotor] for joint in arm.joints])
    parameters[-1, :10] += np.array([1.5, 0.0, 0.0, 0.15, 0.02, 0.0, 0.02, 0.0, 0.0, 0.01])
    loaded = arm.with_bodies(parameters)
    assert last.inertial is not None
    (tmp_path / "loaded").mkdir()
    motion_of(loaded, friction_of(arm), tmp_path / "loaded", (2,), **options)
    files = [str(tmp_path / "run_1.parquet"), str(tmp_path / "loaded" / "run_2.parquet")]
    reading = ReadOptions(map=MAP["map"])
    found = fit_robot(read_motion(arm, files, reading, first.cutoff), payload=["run_2"])
    assert found.payload is not None
    low, high = found.payload.mass_ci95
    assert low - 0.01 < 1.5 < high + 0.01
    assert high - low < 0.1


@pytest.mark.slow
def test_a_known_payload_shows_the_drive_gains(arm: Robot, tmp_path: Path) -> None:
    """Torques computed with gains that are wrong by up to a tenth; one payload, one run without."""
    known = KnownPayload(4.0, (0.05, 0.0, 0.02))
    parameters = np.array([[*joint.inertial, joint.rotor] for joint in arm.joints])
    parameters[-1, :10] += known.parameters
    options = {"seconds": 15.0, "rate": 100.0, "noise": 0.01}
    motion_of(arm, friction_of(arm), tmp_path, (1,), **options)
    motion_of(arm.with_bodies(parameters), friction_of(arm), tmp_path, (2,), **options)
    ratios = (1.1, 0.92, 1.0, 0.97)
    files = [str(tmp_path / f"run_{k}.parquet") for k in (1, 2)]
    factors = dict(zip(arm.names, ratios, strict=True))
    wrong = [pl.col(f"torque_{name}") / ratio for name, ratio in factors.items()]
    for path in files:
        pl.read_parquet(path).with_columns(wrong).write_parquet(path)
    motion = read_motion(arm, files, ReadOptions(map=MAP["map"]), 10.0)
    found = fit_robot(motion, payload=["run_2"], known_payload=known)
    for gain, ratio in zip(found.drive_gains, ratios, strict=True):
        assert gain.ratio is not None and gain.ci95 is not None
        low, high = gain.ci95
        # One interval in twenty misses by a little.
        assert low - 0.5 * (high - low) < ratio < high + 0.5 * (high - low)
        assert high - low < 0.05
    assert found.to_dict()["drive_gains"][0]["ratio"] == found.drive_gains[0].ratio
    assert "Drive gains, from the known payload:" in repr(found)
    assert "a known payload shows" in robot_fit_page(found)
    # A payload that is not there has no torque, and shows nothing.
    motion_of(arm, friction_of(arm), tmp_path, (2,), **options)
    pl.read_parquet(files[1]).with_columns(wrong).write_parquet(files[1])
    empty = read_motion(arm, files, ReadOptions(map=MAP["map"]), 10.0)
    without = fit_robot(empty, payload=["run_2"], known_payload=known)
    assert {gain.ratio for gain in without.drive_gains} == {None}
    assert "its torque does not show here" in repr(without)
    with pytest.raises(FitError, match="the known payload is in no run: name the run"):
        fit_robot(motion, known_payload=known)
    with pytest.raises(FitError, match="its mass must be above zero"):
        KnownPayload(-1.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--payload-centre", "0,0,0.1"], "--payload-centre needs --payload-mass"),
        (["--payload-mass", "2", "--payload-centre", "1,2"], "--payload-centre 1,2: write X,Y,Z"),
        (["--payload-mass", "0"], "its mass must be above zero"),
    ],
)
def test_a_payload_that_is_not_stated_well(words: list[str], said: str, tmp_path: Path) -> None:
    path = tmp_path / "scara.urdf"
    path.write_text(arms.urdf("scara"))
    done = CliRunner().invoke(cli, ["robot", "fit", "run.csv", "--urdf", str(path), *words])
    assert said in str(done.exception)


@pytest.mark.slow
def test_load_is_found_on_its_joint_alone(arm: Robot, tmp_path: Path) -> None:
    loaded = arm.names[0]
    options = {"seconds": 20.0, "rate": 100.0, "noise": 0.01}
    found = improve_robot(motion_of(arm, friction_of(arm, loaded), tmp_path, (1, 2), **options))
    added = {name: [step.finding.effect for step in steps] for name, steps in found.steps.items()}
    assert added == {name: ["load"] if name == loaded else [] for name in arm.names}
    assert found.rigid_body == ()


def test_tables_place_the_joints() -> None:
    # An arm of two links, 0.4 m and 0.3 m, in the plane x, z, with 1 kg at its tip.
    quarter = float(np.pi / 2)
    tip = np.array([1.0, 0.3, 0.0, 0.0, 0.0, 0.0, 0.09, 0.0, 0.0, 0.09, 0.0])
    bodies = np.stack([np.zeros(11), tip])
    position, still = np.array([[0.2, 0.5]]), np.zeros((1, 2))
    for convention, rows in (
        ("standard", [{"a": 0.4}, {"a": 0.3}]),
        ("modified", [{}, {"a": 0.4}]),
    ):
        flat = from_tables("flat", rows, convention=convention, gravity=(0.0, -9.81, 0.0))
        torque = flat.with_bodies(bodies).torque(position, still, still)
        second = 9.81 * 0.3 * np.cos(0.7)
        assert np.allclose(torque, [[second + 9.81 * 0.4 * np.cos(0.2), second]])
    upright = from_tables("upright", [{"alpha": quarter}, {"a": 0.3}])
    torque = upright.with_bodies(bodies).torque(position, still, still)
    assert np.allclose(torque, [[0.0, 9.80665 * 0.3 * np.cos(0.5)]])


def test_a_robot_reads_back(arm: Robot, tmp_path: Path) -> None:
    options = {"seconds": 10.0, "rate": 100.0, "noise": 0.01}
    motion = motion_of(arm, friction_of(arm), tmp_path, (1,), **options)
    found = fit_robot(motion)
    path = tmp_path / "fitted.toml"
    write_robot(found, path)
    again, friction = read_robot(path), read_friction(path)
    assert again.names == arm.names
    expected = arm.with_bodies(found.bodies.parameters)
    arrays = (motion.position, motion.velocity, motion.acceleration)
    assert np.array_equal(again.torque(*arrays), expected.torque(*arrays))
    for joint in found.joints:
        assert np.array_equal(friction[joint.joint].values, joint.model.values)
    with pytest.raises(ModelFileError, match="two joints have the same name"):
        path.write_text(path.read_text().replace('"joint_1"', '"joint_0"'))
        read_robot(path)


def test_an_updated_urdf_has_the_same_torques(arm: Robot, tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    bodies = [[*inertial_of(0.3 * random.normal(size=10)), 0.0] for _ in arm.joints]
    robot = arm.with_bodies(np.array(bodies))
    path = tmp_path / "updated.urdf"
    write_urdf(path, arm.source, robot, friction_of(arm))
    again = read_urdf(path)
    position, velocity, acceleration = arms.states("scara", 20)
    expected = robot.torque(position, velocity, acceleration)
    found = again.torque(position, velocity, acceleration)
    assert np.max(np.abs(found - expected)) < 1e-10 * np.max(np.abs(expected))
    assert '<dynamics damping="2.0" friction="3.0"' in path.read_text()
    other = from_tables("other", [{"a": 0.4}])
    with pytest.raises(ModelFileError, match="has no joint 1"):
        write_urdf(path, arm.source, other, {})


def test_a_planned_motion_keeps_its_limits(arm: Robot) -> None:
    limits = Limits(-0.8, 1.2, 1.0, 4.0)
    made = plan_robot(arm, limits, seconds=10.0, rate=50.0, tried=60)
    assert made.gain > 1.0
    for k in range(len(arm.joints)):
        motion = (made.position[:, k], made.velocity[:, k], made.acceleration[:, k])
        assert limits.hold(SampledMotion(made.time, *motion))
        assert max(abs(motion[1][0]), abs(motion[1][-1])) < 1e-9
        assert np.max(np.abs(np.gradient(motion[0], made.time) - motion[1])) < 0.05
    with pytest.raises(SpecError, match="no limits of joint joint_1"):
        plan_robot(arm, {"joint_0": limits})


def test_log_cholesky_factors_give_bodies() -> None:
    for seed in range(5):
        values = np.random.default_rng(seed).normal(size=10)
        assert np.linalg.eigvalsh(pseudo_inertia(inertial_of(values))).min() > 0.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("kind = 'model'", 'kind = "robot" is needed'),
        ("kind = 'robot'", "one of urdf = FILE, mjcf = FILE and convention"),
        ("kind = 'robot'\nconvention = 'dh'\n[[joint]]", "standard, modified or frames"),
        ("kind = 'robot'\nconvention = 'standard'", "there is no joint"),
        ("kind = 'robot'\nconvention = 'standard'\n[[joint]]\nb = 1", "line 4: key 'b' is unknown"),
        ("kind = 'robot'\nconvention = 'standard'\n[[joint]]\na = nan", "a is a number"),
        ("kind = 'robot'\nurdf = 'nothing.urdf'", "cannot read the URDF"),
    ],
)
def test_robot_files_that_cannot_be_used(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(text)
    with pytest.raises(ModelFileError, match=said):
        read_robot(path)


def test_bad_urdf(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text("<robot name='x'><link name='a'/></robot>")
    with pytest.raises(ModelFileError, match="no joint moves"):
        read_robot(path)
    path.write_text("<robot")
    with pytest.raises(ModelFileError, match="not a URDF that can be read"):
        read_robot(path)


def test_columns_that_cannot_be_named(arm: Robot) -> None:
    with pytest.raises(RecordingError, match="cannot be named for a joint"):
        read_motion(arm, ["run.csv"], ReadOptions(map=["position=q_{axis}"]))


def test_names_that_do_not_exist(arm: Robot, tmp_path: Path) -> None:
    motion = motion_of(arm, {}, tmp_path, (1,), seconds=5.0, noise=0.01)
    with pytest.raises(FitError, match="has no joint 'joint_9'"):
        fit_robot(motion, of_joints={"joint_9": "coulomb"})
    with pytest.raises(FitError, match="has no run 'x'"):
        fit_robot(motion, payload=["x"])
    with pytest.raises(SpecError, match="has no joint"):
        simulate_robot(arm, {"elbow": sb.model("coulomb")})
