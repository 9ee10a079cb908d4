"""A cause in the rigid bodies lowers the error in the joints that it loads."""

from __future__ import annotations

import numpy as np
import polars as pl
import stribeck as sb
from stribeck import robot
from stribeck.robot.causes import Found, rigid_causes
from stribeck.robot.consistent import consistent_bodies
from stribeck.robot.estimates import base_estimates
from stribeck.robot.fit import balance_of, solve_ordinary


def found_in(**changed: pl.Expr) -> list[Found]:
    """Causes found where columns of a simulated arm with two links in a vertical plane change."""
    arm = robot.from_tables("arm", [{"a": 0.4}, {"a": 0.3}], gravity=(0.0, -9.81, 0.0))
    arm = arm.with_bodies(np.array([[3.0, -0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]] * 2))
    plain = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)
    run = robot.simulate_robot(
        arm, dict.fromkeys(arm.names, plain), seconds=40.0, rate=50.0, noise=0.05
    ).with_columns(**changed)
    motion = robot.RobotMotion.of(arm, [sb.read(run, joint=name) for name in arm.names])
    solved = solve_ordinary(balance_of(motion, ()))
    bodies = consistent_bodies(solved, base_estimates(solved))
    return rigid_causes(solved, bodies.parameters, 0.01)


def test_a_cable_is_found_at_its_own_joint() -> None:
    found = found_in(torque_2=pl.col("torque_2") + 6.0 * pl.col("position_2") ** 3)
    assert [one.cause.text for one in found] == ["a spring, balancer or cable at joint 2"]
    assert found[0].own > 0.9
