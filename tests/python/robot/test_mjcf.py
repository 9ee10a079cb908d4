"""Robots from MJCF, and MJCF with what was identified: torques as MuJoCo has them."""

from __future__ import annotations

from pathlib import Path

import arms
import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import ModelFileError
from stribeck.robot.arm import Robot
from stribeck.robot.consistent import inertial_of
from stribeck.robot.describe import read_robot
from stribeck.robot.updated_mjcf import write_mjcf
from stribeck.robot.updated_urdf import write_urdf
from stribeck.robot.urdf import read_urdf

#: A slide on a hinge, an axis beside the origin of its body, a reference, a fixed body, defaults.
ARM = """<?xml version="1.0"?>
<!-- an arm -->
<mujoco model="made">
  <compiler angle="degree" autolimits="true" boundmass="0.001"/>
  <option gravity="0.5 0 -9.81"/>
  <default><joint armature="0.02" damping="3"/></default>
  <worldbody>
    <body name="stand" pos="0 0 0.4"><geom type="box" size=".1 .1 .1"/>
      <body name="upper" pos="0.1 0 0.2" euler="20 -30 40">
        <joint name="shoulder" axis="0 1 0" pos="0.02 -0.03 0.05" armature="0.3"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.04" mass="3"/>
        <body name="plate" pos="0.1 0 0" quat="0.9 0.1 0.2 0.3">
          <geom type="box" size=".05 .1 .02" mass="0.7"/></body>
        <body name="fore" pos="0.3 0 0" euler="0 90 10">
          <joint name="slide" type="slide" axis="0.6 0 0.8" ref="0.2"/>
          <inertial pos="0.1 0.02 0" quat="0.8 0 0.6 0" mass="1.5" diaginertia=".02 .03 .04"/>
          <body name="hand" pos="0.1 0.2 0">
            <joint name="wrist" axis="1 1 0" ref="25" damping="0.4" frictionloss="0.1"/>
            <geom type="ellipsoid" size=".05 .06 .07" mass="0.9"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""

mujoco = pytest.importorskip("mujoco")


def torque_by_mujoco(model: mujoco.MjModel, states: tuple[np.ndarray, ...]) -> np.ndarray:
    """Torques of MuJoCo's inverse dynamics, without friction, contacts and limits."""
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    model.dof_damping[:] = 0.0
    data = mujoco.MjData(model)
    rows = []
    for position, velocity, acceleration in zip(*states, strict=True):
        data.qpos[:], data.qvel[:], data.qacc[:] = position, velocity, acceleration
        mujoco.mj_inverse(model, data)
        rows.append(data.qfrc_inverse.copy())
    return np.array(rows)


def states(joints: int) -> tuple[np.ndarray, ...]:
    return tuple(np.random.default_rng(5).uniform(-2.0, 2.0, (3, 50, joints)))


def agree(robot: Robot, path: Path) -> None:
    motion = states(len(robot.joints))
    expected = torque_by_mujoco(mujoco.MjModel.from_xml_path(str(path)), motion)
    found = robot.torque(*motion)
    assert np.max(np.abs(found - expected)) < 1e-10 * np.max(np.abs(expected))


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm.xml"
    path.write_text(ARM)
    return path


def test_torques_are_those_of_mujoco(arm: Path) -> None:
    robot = read_robot(arm)
    assert robot.name == "made"
    assert robot.names == ("shoulder", "slide", "wrist")
    assert [joint.rotor for joint in robot.joints] == [0.3, 0.02, 0.02]
    agree(robot, arm)


def test_urdf_by_mujoco(tmp_path: Path) -> None:
    """MuJoCo reads URDF too; MJCF that it writes gives the torques of the URDF."""
    path = tmp_path / "two_arms.urdf"
    path.write_text(arms.urdf("two_arms"))
    model = mujoco.MjModel.from_xml_path(str(path))
    made = tmp_path / "made.xml"
    mujoco.mj_saveLastXML(str(made), model)
    again, robot = read_robot(made), read_urdf(path)
    motion = states(len(robot.joints))
    order = [again.names.index(joint) for joint in robot.names]
    placed = tuple(np.empty_like(column) for column in motion)
    for column, own in zip(placed, motion, strict=True):
        column[:, order] = own
    expected = robot.torque(*motion)
    found = again.torque(*placed)[:, order]
    # MuJoCo writes six digits, and gravity of 9.81 m/s2.
    assert np.max(np.abs(found - expected)) < 1e-3 * np.max(np.abs(expected))


def test_updated_mjcf_has_the_identified_torques(arm: Path, tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    bodies = [[*inertial_of(0.3 * random.normal(size=10)), random.uniform()] for _ in range(3)]
    robot = read_robot(arm).with_bodies(np.array(bodies))
    friction = {
        name: sb.model("coulomb", coulomb_friction=1.0 + k, viscous_friction=0.5 + k)
        for k, name in enumerate(robot.names)
    }
    path = tmp_path / "updated.xml"
    write_mjcf(path, arm, robot, friction)
    agree(robot, path)
    agree(read_robot(path), path)
    model = mujoco.MjModel.from_xml_path(str(path))
    assert model.dof_frictionloss.tolist() == [1.0, 2.0, 3.0]
    assert model.dof_damping.tolist() == [0.5, 1.5, 2.5]
    assert model.dof_armature.tolist() == [joint.rotor for joint in robot.joints]


@pytest.fixture
def updated_urdf(tmp_path: Path) -> tuple[Path, Robot]:
    """An updated URDF of a tree with a slide, and the identified robot."""
    source, path = tmp_path / "two_arms.urdf", tmp_path / "updated.urdf"
    source.write_text(arms.urdf("two_arms"))
    random = np.random.default_rng(2)
    robot = read_urdf(source)
    robot = robot.with_bodies(
        np.array([[*inertial_of(0.3 * random.normal(size=10)), 0.0] for _ in robot.joints])
    )
    friction = {
        name: sb.model("coulomb", coulomb_friction=1.0 + k, viscous_friction=0.5 + k)
        for k, name in enumerate(robot.names)
    }
    write_urdf(path, source, robot, friction)
    return path, robot


def test_mujoco_loads_an_updated_urdf(updated_urdf: tuple[Path, Robot]) -> None:
    path, robot = updated_urdf
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.gravity[:] = robot.gravity
    order = [robot.names.index(model.joint(k).name) for k in range(model.njnt)]
    assert model.dof_frictionloss.tolist() == [1.0 + k for k in order]
    assert model.dof_damping.tolist() == [0.5 + k for k in order]
    motion = states(len(robot.joints))
    found = torque_by_mujoco(model, tuple(column[:, order] for column in motion))
    expected = robot.torque(*motion)[:, order]
    assert np.max(np.abs(found - expected)) < 1e-10 * np.max(np.abs(expected))


def test_pinocchio_loads_an_updated_urdf(updated_urdf: tuple[Path, Robot]) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    path, robot = updated_urdf
    model = pinocchio.buildModelFromUrdf(str(path))
    model.gravity.linear = np.array(robot.gravity)
    order = [robot.names.index(name) for name in list(model.names)[1:]]
    motion = states(len(robot.joints))
    data = model.createData()
    rows = zip(*(column[:, order] for column in motion), strict=True)
    found = np.array([pinocchio.rnea(model, data, q, v, a) for q, v, a in rows])
    expected = robot.torque(*motion)[:, order]
    assert np.max(np.abs(found - expected)) < 1e-10 * np.max(np.abs(expected))


def test_mjcf_of_another_robot(arm: Path, tmp_path: Path) -> None:
    robot = read_robot(arm)
    other = tmp_path / "other.xml"
    for old, new, said in (
        ('name="wrist"', 'name="elbow"', "has no joint wrist: give the robot's own MJCF"),
        ('axis="1 1 0"', 'axis="1 0 0"', "joint wrist of .* stands elsewhere"),
    ):
        other.write_text(ARM.replace(old, new))
        with pytest.raises(ModelFileError, match=said):
            write_mjcf(tmp_path / "out.xml", other, robot, {})
    assert not (tmp_path / "out.xml").exists()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('axis="0 1 0" pos', 'type="ball" pos', "joint 'shoulder' is free or a ball"),
        ('ref="0.2"/>', 'stiffness="3"/>', "a joint with a stiffness cannot be read"),
        ("</worldbody>", "</world>", "MuJoCo refuses it"),
        ("<joint name", "<geom name", "no joint moves|MuJoCo refuses it"),
        (
            "</worldbody>",
            '</worldbody><equality><joint joint1="shoulder" joint2="wrist"/></equality>',
            "an? equality constraint cannot be read",
        ),
        ('<joint name="slide"', '<joint name="turn"/><joint name="slide"', "'fore' has 2 joints"),
    ],
)
def test_mjcf_that_cannot_be_read(old: str, new: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "arm.xml"
    path.write_text(ARM.replace(old, new))
    with pytest.raises(ModelFileError, match=said):
        read_robot(path)
