"""Rigid bodies of a seven-joint arm, here and by Pinocchio in a loop over the samples."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin
from stribeck.robot.arm import Robot
from stribeck.robot.tables import from_tables
from timing import line

SAMPLES = 2000
GRAVITY = (0.0, 0.0, -9.81)
#: Largest difference, as a share of the largest value.
APART = 1e-10


def described() -> Robot:
    """An arm with alternating axes; its links are rods of 3 kg."""
    turns = (-1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 0.0)
    rows = [
        {"alpha": turn * np.pi / 2, "d": 0.3 * (k % 2 == 0), "a": 0.05}
        for k, turn in enumerate(turns)
    ]
    rod = [3.0, 0.15, 0.0, 0.3, 0.07, 0.0, 0.08, -0.01, 0.0, 0.02, 0.0]
    return from_tables("arm", rows, gravity=GRAVITY).with_bodies(np.array([rod] * len(rows)))


def theirs(robot: Robot) -> pin.Model:
    """The same arm."""
    model = pin.Model()
    model.gravity.linear = np.array(GRAVITY)
    for joint in robot.joints:
        parent = 0 if joint.parent is None else joint.parent + 1
        place = pin.SE3(joint.rotation, joint.translation)
        made = model.addJoint(parent, pin.JointModelRZ(), place, joint.name)
        mass, *moment, xx, xy, yy, xz, yz, zz = joint.inertial
        # The regressor's parameters, in Pinocchio's order: xx, xy, yy, xz, yz, zz as well.
        own = pin.Inertia.FromDynamicParameters(np.array([mass, *moment, xx, xy, yy, xz, yz, zz]))
        model.appendBodyToJoint(made, own, pin.SE3.Identity())
    return model


def check(found: np.ndarray, expected: np.ndarray) -> None:
    apart = np.abs(found - expected).max() / np.abs(expected).max()
    assert apart < APART, f"{apart:.3g} apart"


def compare_arms() -> None:
    """Check that both compute the same, then print their times."""
    robot = described()
    model = theirs(robot)
    data, joints = model.createData(), len(robot.joints)
    motion = np.random.default_rng(1).uniform(-2.0, 2.0, (3, SAMPLES, joints))

    def one_by_one(function: Callable[..., object]) -> Callable[[], None]:
        def run() -> None:
            for q, v, a in zip(*motion, strict=True):
                function(model, data, q, v, a)

        return run

    first = motion[:, 0]
    regressor = robot.regressor(*motion)[0].reshape(joints, joints, 11)[:, :, :10]
    expected = pin.computeJointTorqueRegressor(model, data, *first)
    check(regressor, expected.reshape(joints, joints, 10))
    for mine, other in zip(
        robot.torque_derivatives(*motion)[:2],
        pin.computeRNEADerivatives(model, data, *first)[:2],
        strict=True,
    ):
        check(mine[0], other)
    for what, ours, function in (
        ("regressor", robot.regressor, pin.computeJointTorqueRegressor),
        ("derivatives of the torques", robot.torque_derivatives, pin.computeRNEADerivatives),
    ):
        line(
            f"seven-joint arm, {what}, {SAMPLES} samples",
            f"Pinocchio {pin.__version__}, loop in Python",
            lambda ours=ours: ours(*motion),
            one_by_one(function),
            15,
        )
