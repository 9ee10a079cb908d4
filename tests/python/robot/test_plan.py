"""Planned motions within torque limits, and with the links apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from stribeck.base.errors import ModelFileError, SpecError
from stribeck.cli.main import cli
from stribeck.motion.design.motion import Limits
from stribeck.robot.arm import Robot, Sphere
from stribeck.robot.describe import read_robot
from stribeck.robot.plan import plan_robot
from stribeck.robot.spheres import clearance, frames
from stribeck.robot.tables import from_tables

LIMITS = Limits(-1.4, 1.4, 2.0, 8.0)


def planar() -> Robot:
    """Two links of 0.5 m in a plane, with 2 kg at the tip of each."""
    tip = [2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.1]
    bare = from_tables("planar", [{"a": 0.5}, {"a": 0.5}], gravity=(0.0, -9.81, 0.0))
    first = [2.0, 0.0, 0.0, 0.0, 0.001, 0.0, 0.001, 0.0, 0.0, 0.001, 0.1]
    return bare.with_bodies(np.array([first, tip]))


def test_frames_follow_the_joints() -> None:
    arm = planar()
    _, origin = frames(arm, np.array([[0.0, 0.0], [np.pi / 2, 0.3]]))
    # The frame of the second link is at the tip of the first.
    assert np.allclose(origin[0, 1], [0.5, 0.0, 0.0])
    assert np.allclose(origin[1, 1], [0.0, 0.5, 0.0])
    rotation, _ = frames(arm, np.array([[0.4, 0.5]]))
    tip = rotation[0, 1] @ [1.0, 0.0, 0.0]
    assert np.allclose(tip, [np.cos(0.9), np.sin(0.9), 0.0])
    slide = replace(arm.joints[1], movement="prismatic", axis=(0.0, 1.0, 0.0))
    sliding = replace(arm, joints=(arm.joints[0], slide))
    _, origin = frames(sliding, np.array([[np.pi / 2, 0.2]]))
    assert np.allclose(origin[0, 1], [-0.2, 0.5, 0.0])


def test_spheres_of_linked_bodies_may_touch() -> None:
    arm = planar()
    ends = (Sphere(None, (0.0, 0.0, 0.0), 0.1), Sphere("2", (0.5, 0.0, 0.0), 0.05))
    folded = np.array([[0.0, np.pi], [0.0, 0.0]])
    apart = clearance(replace(arm, spheres=ends), folded)
    assert np.allclose(apart, [-0.15, 0.85])
    touching = (Sphere(None, (0.0, 0.0, 0.0), 0.4), Sphere("1", (0.3, 0.0, 0.0), 0.4))
    assert np.all(clearance(replace(arm, spheres=touching), folded) == np.inf)


def test_limits_of_torque_and_distance_are_kept() -> None:
    arm = planar()
    free = plan_robot(arm, LIMITS, seconds=10.0, rate=100.0, tried=150)
    assert free.torque is not None
    # A wall that the tip of the second link reaches in the free motion.
    q = np.concatenate([free.position, free.position])
    rotation, origin = frames(arm, q)
    tip = (origin[:, 1] + rotation[:, 1] @ [0.5, 0.0, 0.0])[:, 1].max()
    wall = Sphere(None, (0.6, tip + 0.05, 0.0), 0.3)
    largest = 0.9 * free.torque
    joints = tuple(
        replace(j, torque_limit=float(t)) for j, t in zip(arm.joints, largest, strict=True)
    )
    limited = replace(arm, joints=joints, spheres=(wall, Sphere("2", (0.5, 0.0, 0.0), 0.05)))
    found = plan_robot(limited, LIMITS, seconds=10.0, rate=100.0, tried=150)
    assert found.torque is not None
    assert np.all(found.torque <= largest)
    assert found.clearance >= 0.0
    assert np.allclose(found.clearance, clearance(limited, found.position).min())
    joints = tuple(replace(joint, torque_limit=1e-3) for joint in arm.joints)
    with pytest.raises(SpecError, match="no motion within the torque limits"):
        plan_robot(replace(arm, joints=joints), LIMITS, seconds=10.0, rate=50.0, tried=30)
    unknown = replace(joints[0], inertial=None)
    with pytest.raises(SpecError, match="inertial parameters of its links are not known"):
        plan_robot(replace(arm, joints=(unknown, joints[1])), LIMITS, tried=30)


TEXT = """kind = "robot"
convention = "standard"
[[joint]]
a = 0.5
torque_limit = 20.0
[[joint]]
a = 0.5
"""


def test_a_robot_file_states_them(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    sphere = '[[sphere]]\njoint = "2"\ncentre = [0.5, 0.0, 0.0]\nradius = 0.05\n'
    path.write_text(TEXT + sphere + "[[sphere]]\nradius = 0.3\n")
    robot = read_robot(path)
    assert [joint.torque_limit for joint in robot.joints] == [20.0, None]
    assert robot.spheres[0] == Sphere("2", (0.5, 0.0, 0.0), 0.05)
    assert robot.spheres[1].joint is None
    said = CliRunner().invoke(cli, ["robot", "plan", str(path), "--seconds", "5"])
    assert "inertial parameters" in str(said.exception)
    path.write_text(TEXT.replace("torque_limit = 20.0\n", "") + sphere)
    words = ["robot", "plan", str(path), "--seconds", "5", "--speed", "3"]
    said = CliRunner().invoke(cli, words)
    assert said.exit_code == 0, said.output
    assert "apart" in said.stdout


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[sphere]]\njoint = '3'\nradius = 0.1", "there is no joint '3'"),
        ("[[sphere]]\nradius = -1.0", "radius is a number above 0"),
        ("[[sphere]]\nradius = 0.1\ncentre = [1.0]", "centre is three finite numbers"),
        ("[[sphere]]\nradius = 0.1\nsize = 1.0", "key 'size' is unknown"),
    ],
)
def test_spheres_that_cannot_be_used(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(TEXT + text)
    with pytest.raises(ModelFileError, match=said):
        read_robot(path)
