"""Arms in closed loop: sticking joints, energy, compensation."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli
from stribeck.recording.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.fit import fit_robot
from stribeck.robot.follow import _Arm, follow_robot, sliding
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


def test_the_step_is_the_least_of_a_convex_function() -> None:
    random = np.random.default_rng(3)
    root = random.normal(size=(6, 6))
    matrix = root @ root.T + 0.1 * np.eye(6)
    right, dry = 3.0 * random.normal(size=6), np.full(6, 1.5)
    v = sliding(matrix, right, dry, np.zeros(6))
    left = right - matrix @ v
    stuck = v == 0.0
    assert stuck.any() and not stuck.all()
    assert np.all(np.abs(left[stuck]) <= dry[stuck])
    assert np.allclose(left[~stuck], dry[~stuck] * np.sign(v[~stuck]), atol=1e-9)


def test_dry_friction_holds_a_link_against_gravity() -> None:
    arm, start = planar(), np.array([-0.4, 0.3])
    still = np.zeros(2)
    gravity = arm.torque(start[None], still[None], still[None])[0]
    held = {name: coulomb(1.01 * abs(g)) for name, g in zip(arm.names, gravity, strict=True)}
    q, v, a = start, still, still
    stepper = _Arm(arm, held, 1e-3, 1.0)
    for _ in range(200):
        q, v, a = stepper.stepped(q, v, a, still)
    assert np.array_equal(q, start)
    slips = {name: coulomb(0.9 * abs(g)) for name, g in zip(arm.names, gravity, strict=True)}
    stepper = _Arm(arm, slips, 1e-3, 1.0)
    for _ in range(200):
        q, v, a = stepper.stepped(q, v, a, still)
    # The second joint is held all the same: the falling arm carries it.
    assert abs(q[0] - start[0]) > 1e-3


def test_without_friction_the_motion_is_that_of_forward_dynamics() -> None:
    arm = planar()
    q, v, a = np.array([0.2, -0.5]), np.array([0.3, 0.1]), np.zeros(2)
    h, torque = 1e-4, np.array([1.0, -0.5])
    _, after, _ = _Arm(arm, {}, h, 1.0).stepped(q, v, a, torque)
    exact = arm.core.forward_dynamics(q[None], v[None], torque[None])[0]
    assert np.allclose((after - v) / h, exact, rtol=1e-9)


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
    nothing = CliRunner().invoke(cli, ["robot", "simulate", str(path)])
    assert "give the recording to write" in str(nothing.exception)
