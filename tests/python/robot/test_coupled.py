"""Motors that turn with several joints: dynamics, recordings, identification, closed loop."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import ModelFileError, RecordingError
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.base_parameters import BaseParameters
from stribeck.robot.describe import read_robot
from stribeck.robot.fit import fit_robot
from stribeck.robot.follow import follow_robot
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import RobotMotion, read_motion
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.stored import write_robot
from stribeck.robot.tables import from_tables

READING = ReadOptions(map=[f"{channel}={column}" for channel, column in COLUMNS])
#: The third motor turns with the second and the third joint, as the last axes of many wrists.
WRIST = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.8, 1.0))


def arm(coupling: tuple[tuple[float, ...], ...] = WRIST) -> Robot:
    """Three joints with crossed axes."""
    table = [
        {"d": 0.3, "alpha": np.pi / 2},
        {"a": 0.4, "alpha": -np.pi / 2},
        {"a": 0.2, "d": 0.1, "alpha": np.pi / 2},
    ]
    links = np.array(
        [
            [5.0, 0.1, -0.2, 0.3, 0.2, 0.01, 0.2, 0.0, 0.02, 0.1, 0.4],
            [4.0, -0.6, 0.1, 0.2, 0.1, 0.02, 0.3, 0.05, 0.01, 0.3, 0.3],
            [2.0, -0.2, 0.05, 0.1, 0.05, 0.0, 0.06, 0.01, 0.0, 0.05, 0.25],
        ]
    )
    return replace(from_tables("wrist", table).with_bodies(links), coupling=coupling)


def friction() -> dict[str, sb.Model]:
    sizes = {"1": (3.0, 2.0), "2": (2.5, 1.0), "3": (1.5, 0.8)}
    return {
        name: sb.model("coulomb", coulomb_friction=dry, viscous_friction=viscous)
        for name, (dry, viscous) in sizes.items()
    }


def motion_of(true: Robot, stated: Robot, folder: Path) -> RobotMotion:
    """Two runs of one robot, read as those of another."""
    files = []
    for seed in (1, 2):
        path = folder / f"run_{seed}.parquet"
        made = simulate_robot(true, friction(), seed=seed, seconds=20.0, rate=100.0, noise=0.01)
        made.write_parquet(path)
        files.append(str(path))
    return read_motion(stated, files, READING, 10.0)


def test_rotors_load_all_joints_that_turn_them() -> None:
    random = np.random.default_rng(5)
    q, v, a = random.uniform(-2.0, 2.0, (3, 50, 3))
    robot, bare = arm(), arm(())
    rotors = np.diag([joint.rotor for joint in robot.joints])
    matrix = np.array(WRIST)
    without = bare.with_bodies(
        np.array([[*joint.inertial, 0.0] for joint in bare.joints])  # type: ignore[misc]
    )
    expected = without.torque(q, v, a) + a @ (matrix.T @ rotors @ matrix)
    assert np.allclose(robot.torque(q, v, a), expected, rtol=1e-12, atol=1e-12)
    mass = robot.core.mass_matrix(q)
    assert np.allclose(mass, without.core.mass_matrix(q) + matrix.T @ rotors @ matrix, rtol=1e-12)
    parameters = np.array([[*j.inertial, j.rotor] for j in robot.joints]).ravel()  # type: ignore[misc]
    assert np.allclose(robot.regressor(q, v, a) @ parameters, expected, rtol=1e-11, atol=1e-11)
    assert np.allclose(robot.core.forward_dynamics(q, v, expected), a, rtol=1e-8, atol=1e-8)


def test_power_is_that_of_the_joints() -> None:
    random = np.random.default_rng(6)
    q, v, a = random.uniform(-2.0, 2.0, (3, 50, 3))
    robot = arm()
    motors = robot.core.of_motors(q, v, a)
    assert np.allclose(motors[0], q @ np.array(WRIST).T, rtol=1e-14)
    assert np.allclose(np.sum(motors[1] * motors[3], axis=1), np.sum(v * robot.torque(q, v, a), 1))
    assert np.array_equal(robot.motor_torque(robot.torque(q, v, a)), motors[3])
    assert np.allclose(robot.joints_of(robot.motors_of(q)), q, rtol=1e-14)


@pytest.mark.parametrize("encoders", ["joints", "motors"])
def test_parameters_lie_in_their_intervals(encoders: str, tmp_path: Path) -> None:
    robot = replace(arm(), encoders=encoders)
    found = fit_robot(motion_of(robot, robot, tmp_path))
    true = np.array([[*j.inertial, j.rotor] for j in robot.joints]).ravel()  # type: ignore[misc]
    expected = BaseParameters.of(robot).mapping @ true
    apart = np.array([row.value for row in found.base_parameters]) - expected
    errors = np.array([row.stderr for row in found.base_parameters])
    assert np.mean(np.abs(apart) < 3.0 * errors) > 0.9
    for joint in found.joints:
        assert joint.relative_residual_held_out < 0.011
        for name in ("coulomb_friction", "viscous_friction"):
            value = friction()[joint.joint].value(name)
            assert abs(joint.estimates[name].value - value) < 4.0 * joint.estimates[name].stderr


@pytest.mark.parametrize("stated", [(), ((1.0, 0, 0), (0, 1.0, 0), (0, -0.8, 1.0))])
def test_a_wrong_coupling_is_found(stated: tuple, tmp_path: Path) -> None:
    found = improve_robot(motion_of(arm(), arm(stated), tmp_path), most_steps=0)
    first = found.rigid_body[0].cause
    than = "otherwise than stated" if stated else "too"
    assert first.text == f"the motor of joint 3 turns with joint 2 {than}"


def test_the_right_coupling_is_not_doubted(tmp_path: Path) -> None:
    assert not improve_robot(motion_of(arm(), arm(), tmp_path), most_steps=0).rigid_body


def test_a_robot_file_keeps_the_coupling(tmp_path: Path) -> None:
    path = tmp_path / "wrist.toml"
    write_robot(fit_robot(motion_of(arm(), arm(), tmp_path)), path)
    robot = read_robot(path)
    assert robot.coupling == WRIST and robot.encoders == "joints"
    assert "motor of joint 3: 0.800 x joint 2" in repr(robot)


def test_a_robot_file_states_motors(tmp_path: Path) -> None:
    path = tmp_path / "wrist.toml"

    def robot(second: str, more: str = "") -> Robot:
        rows = f'[[joint]]\nname = "a"\n[[joint]]\nname = "b"\n{second}\n'
        path.write_text(f'kind = "robot"\nconvention = "standard"\n{more}\n{rows}')
        return read_robot(path)

    assert robot("motor_turns = {a = 0.5, b = 1}").coupling == ((1.0, 0.0), (0.5, 1.0))
    assert robot("motor_turns = {b = 1}").coupling == ()
    assert robot("", 'encoders = "motors"').encoders == "motors"
    for second, said in (
        ("motor_turns = {c = 1.0}", "there is no joint 'c'"),
        ("motor_turns = {a = 1.0}", "all motors rest"),
        ("motor_turns = {}", "table of joints"),
        ('motor_turns = {a = "x"}', "number for each joint"),
        ("motor_turn = {a = 1.0}", "motor_turns"),
    ):
        with pytest.raises(ModelFileError, match=said):
            robot(second)
    with pytest.raises(ModelFileError, match="joints or motors"):
        robot("", 'encoders = "links"')


def test_positions_of_joints_have_columns_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "run.parquet"
    simulate_robot(arm(), friction(), seconds=5.0, rate=100.0).write_parquet(path)
    reading = ReadOptions(map=["time=time", "position=position_1", "torque=torque_{joint}"])
    with pytest.raises(RecordingError, match="a column of each joint"):
        read_motion(arm(), [str(path)], reading)


def test_positions_in_degrees_are_understood(tmp_path: Path) -> None:
    path, other = tmp_path / "rad.parquet", tmp_path / "deg.parquet"
    made = simulate_robot(arm(), friction(), seconds=5.0, rate=100.0)
    made.write_parquet(path)
    in_degrees = [pl.col(f"position_{k}").degrees().alias(f"q_deg_{k}") for k in (1, 2, 3)]
    made.with_columns(in_degrees).write_parquet(other)
    first = read_motion(arm(), [str(path)], READING, 10.0)
    pairs = dict(COLUMNS) | {"position": "q_deg_{number}"}
    second = read_motion(arm(), [str(other)], ReadOptions(map=pairs), 10.0)
    assert np.allclose(first.position, second.position, atol=1e-9)
    assert np.allclose(first.joints[2].position, second.joints[2].position, atol=1e-9)


def test_a_coupled_arm_follows_a_motion_with_its_friction() -> None:
    robot = arm()
    found = follow_robot(robot, friction(), {"known": friction()}, seconds=4.0, speed=0.5)
    without, known = (run.error for run in found.runs)
    assert np.all(known < 0.1 * without)


def test_a_joint_that_mimics_another_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("urdf_parser_py")
    path = tmp_path / "gripper.urdf"
    links = "".join(f'<link name="{name}"/>' for name in ("base", "a", "b"))
    path.write_text(
        f'<robot name="gripper">{links}<joint name="left" type="revolute"><parent link="base"/>'
        '<child link="a"/><limit effort="1" velocity="1" lower="-1" upper="1"/></joint>'
        '<joint name="right" type="revolute"><parent link="base"/><child link="b"/>'
        '<limit effort="1" velocity="1" lower="-1" upper="1"/><mimic joint="left"/></joint></robot>'
    )
    with pytest.raises(ModelFileError, match="'right' mimics 'left'"):
        read_robot(path)
