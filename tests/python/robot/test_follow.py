"""Arms in closed loop: sticking joints, energy, compensation."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli
from stribeck.motion.simulate.drive import Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.fit import fit_robot
from stribeck.robot.follow import follow_robot
from stribeck.robot.motion import read_motion
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.stored import write_robot
from stribeck.robot.tables import from_tables


def planar() -> Robot:
    """Two links of 0.5 m that swing under gravity."""
    tip = [2.0, 0.6, 0.0, 0.0, 0.01, 0.0, 0.25, 0.0, 0.0, 0.25, 0.05]
    bare = from_tables("planar", [{"a": 0.5}, {"a": 0.5}], gravity=(0.0, -9.81, 0.0))
    return bare.with_bodies(np.array([tip, tip]))


def coulomb(size: float, viscous: float = 0.5) -> sb.Model:
    return sb.model("coulomb", coulomb_friction=size, viscous_friction=viscous)


def moved(
    arm: Robot, models: Sequence[sb.Model], start: np.ndarray, torque: np.ndarray, step: float
) -> dict[str, np.ndarray]:
    """The arm from rest at `start`, pushed by torques [steps, N]."""
    columns = {"torque": torque, "temperature": np.full_like(torque, 25.0)}
    columns |= {name: np.zeros_like(torque) for name in ("desired_position", "desired_velocity")}
    made, unsolved = _core.simulate_robot(
        arm.core,
        [model.core for model in models],
        [model.values for model in models],
        columns,
        step,
        (start.tolist(), [0.0] * start.size),
        [None] * start.size,
    )
    assert unsolved == 0
    return made


def test_dry_friction_holds_a_link_against_gravity() -> None:
    arm, start = planar(), np.array([-0.4, 0.3])
    still = np.zeros(2)
    gravity = arm.torque(start[None], still[None], still[None])[0]
    nothing = np.zeros((200, 2))
    held = moved(arm, [coulomb(1.01 * abs(g)) for g in gravity], start, nothing, 1e-3)
    assert np.array_equal(held["position"][-1], start)
    slips = moved(arm, [coulomb(0.9 * abs(g)) for g in gravity], start, nothing, 1e-3)
    # The second joint is held all the same: the falling arm carries it.
    assert abs(slips["position"][-1, 0] - start[0]) > 1e-3


def test_without_friction_the_motion_is_that_of_forward_dynamics() -> None:
    arm, start, h = planar(), np.array([0.2, -0.5]), 1e-6
    torque = np.array([[1.0, -0.5]])
    made = moved(arm, [coulomb(0.0, 0.0)] * 2, start, torque, h)
    exact = arm.core.forward_dynamics(start[None], np.zeros((1, 2)), torque)[0]
    assert np.allclose(made["velocity"][1] / h, exact, rtol=1e-6)


LUGRE = {
    "bristle_stiffness": 3000.0,
    "bristle_damping": 10.0,
    "viscous_friction": 0.5,
    "coulomb_friction": 2.0,
    "static_friction": 3.0,
    "stribeck_velocity": 0.05,
    "stribeck_exponent": 2.0,
}


def test_one_joint_with_a_state_moves_as_a_single_joint() -> None:
    tip = [2.0, 0.6, 0.0, 0.0, 0.01, 0.0, 0.25, 0.0, 0.0, 0.25, 0.05]
    bare = from_tables("swing", [{"a": 0.5}], gravity=(0.0, -9.81, 0.0))
    arm, start, level = bare.with_bodies(np.array([tip])), np.array([-1.2]), np.zeros((1, 1))
    joint = Joint(
        float(arm.core.mass_matrix(level)[0, 0, 0]),
        gravity_cos=float(arm.core.gravity_torque(level)[0, 0]),
    )
    lugre, torque = sb.model("lugre", **LUGRE), 8.0 * np.sin(3e-3 * np.arange(3000))
    alone = sb.simulate(lugre, joint, Torque(torque), position=-1.2, step=1e-3)
    made = moved(arm, [lugre], start, torque[:, None], 1e-3)
    assert np.max(np.abs(made["position"][:, 0] - alone.instant_position)) < 1e-9
    assert np.max(np.abs(made["friction_torque"][:, 0] - alone.friction_torque)) < 1e-8
    assert np.ptp(made["position"]) > 0.5


def test_bristles_hold_and_spring_back() -> None:
    arm = planar()
    lugre = sb.model("lugre", **LUGRE)
    start = np.array([-1.4, -0.1])
    gravity = arm.core.gravity_torque(start[None])[0]
    push = np.concatenate(
        [np.linspace(0.0, 1.0, 1000), np.linspace(1.0, 0.0, 1000), np.zeros(2000)]
    )
    torque = np.outer(push, [1.0, 0.0]) + gravity
    q = moved(arm, [lugre, lugre], start, torque, 1e-3)["position"][:, 0]
    bent, left = q[1000] - start[0], q[-1] - start[0]
    assert 0.8 / 3000.0 < bent < 3.0 / 3000.0
    assert abs(left) < 0.5 * bent
    # A law by its steady friction alone would not move at all.


def test_bits_do_not_depend_on_the_run() -> None:
    arm = planar()
    friction = dict(zip(arm.names, (sb.model("lugre", **LUGRE), coulomb(2.0)), strict=True))
    first, second = (follow_robot(arm, friction, {}, seconds=1.0) for _ in range(2))
    assert np.array_equal(first.runs[0].torque, second.runs[0].torque)


def test_known_friction_is_compensated() -> None:
    arm = planar()
    true = dict(zip(arm.names, (coulomb(4.0), coulomb(2.0)), strict=True))
    half = dict(zip(arm.names, (coulomb(2.0, 0.25), coulomb(1.0, 0.25)), strict=True))
    found = follow_robot(arm, true, {"half": half, "all": true}, seconds=3.0)
    without, part, whole = (run.error for run in found.runs)
    assert np.all(part < 0.75 * without)
    assert np.all(whole < 0.2 * without)
    assert [run.name for run in found.runs] == ["", "half", "all"]
    assert found.to_frame().height == 3000
    assert "all" in repr(found) and "mrad" in repr(found)
    with pytest.raises(SpecError, match="has no joint 'elbow'"):
        follow_robot(arm, {"elbow": coulomb(1.0)}, {})
    with pytest.raises(SpecError, match="bandwidth"):
        follow_robot(arm, true, {}, bandwidth=1e4)


def test_the_command_compares_files(tmp_path: Path) -> None:
    arm = planar()
    run = tmp_path / "run.parquet"
    true = dict(zip(arm.names, (coulomb(4.0), coulomb(2.0)), strict=True))
    simulate_robot(arm, true, seconds=20.0, rate=50.0, noise=0.01).write_parquet(run)
    reading = ReadOptions(map=[f"{channel}={column}" for channel, column in COLUMNS])
    path, out = tmp_path / "fitted.toml", tmp_path / "closed.parquet"
    write_robot(fit_robot(read_motion(arm, [str(run)], reading)), path)
    words = ["robot", "simulate", str(path), "--compensate", str(path), "--seconds", "1"]
    said = CliRunner().invoke(cli, [*words, "-o", str(out), "--json"])
    assert said.exit_code == 0, said.output
    without, fitted = json.loads(said.stdout)["runs"]
    assert fitted["compensation"] == "fitted"
    for before, after in zip(without["joints"], fitted["joints"], strict=True):
        assert after["rms_error"] < before["rms_error"]
    assert out.exists()
    other = tmp_path / "joint.toml"
    coulomb(4.0).save(other)
    wrong = CliRunner().invoke(cli, [*words[:4], str(other), "--seconds", "1"])
    assert "kind = \"robot\" is needed, not 'model'" in str(wrong.exception)
    made = CliRunner().invoke(cli, [*words[:3], "-o", str(tmp_path / "open.csv"), "--json"])
    assert json.loads(made.stdout)["rows"] == 6000
    nothing = CliRunner().invoke(cli, ["robot", "simulate", str(path)])
    assert "give the recording to write" in str(nothing.exception)
    noisy = CliRunner().invoke(cli, [*words, "--noise", "0.1"])
    assert "--noise has no effect with --compensate" in str(noisy.exception)
    alone = CliRunner().invoke(cli, [*words[:3], "-o", str(out), "--bandwidth", "9"])
    assert "--bandwidth has no effect without --compensate" in str(alone.exception)
