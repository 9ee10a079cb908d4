"""Effects hidden in one joint of a six-joint arm: found on that joint, and on no other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.arm import Robot
from stribeck.robot.improve import improve_robot
from stribeck.robot.motion import read_motion
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.tables import from_tables

#: a [m], d [m], alpha [rad] of a six-joint arm, and mass [kg] of its links.
ROWS = (
    (0.0, 0.18, np.pi / 2, 7.0),
    (-0.61, 0.0, 0.0, 12.0),
    (-0.57, 0.0, 0.0, 4.0),
    (0.0, 0.17, np.pi / 2, 2.0),
    (0.0, 0.12, -np.pi / 2, 2.0),
    (0.0, 0.12, 0.0, 0.5),
)
HIDDEN = (
    ("2", "load", {"load_coulomb": 0.12, "load_exponent": 1.0}, {"reference_load": 50.0}),
    (
        "4",
        "nonlinear_viscous",
        {
            "nonlinear_viscous_coefficient": 2.0,
            "nonlinear_viscous_exponent": 2.0,
            "nonlinear_viscous_saturation": 10.0,
        },
        {"reference_velocity": 1.0},
    ),
    ("5", "direction", {"direction_viscous": 0.6}, {}),
)


def arm() -> Robot:
    bare = from_tables("arm", [{"a": a, "d": d, "alpha": alpha} for a, d, alpha, _ in ROWS])
    bodies = []
    for a, _, _, mass in ROWS:
        x = 0.5 * a
        inertia = 0.02 * mass + mass * x * x
        bodies.append(
            [mass, mass * x, 0.0, 0.02 * mass, 0.02 * mass, 0.0, inertia, 0.0, 0.0, inertia, 0.3]
        )
    return bare.with_bodies(np.array(bodies))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(len(HIDDEN)))
def test_right_joint_and_effect_come_first(seed: int, tmp_path: Path) -> None:
    robot = arm()
    name, effect, own, constants = HIDDEN[seed]
    friction = {}
    for k, joint in enumerate(robot.names):
        plain = {"coulomb_friction": 12.0 / (k + 1), "viscous_friction": 10.0 / (k + 1)}
        law = sb.model("coulomb", **plain)
        if joint == name:
            law = law.with_effect(effect, constants)
            law = law.with_values([{**plain, **own}.get(n, 0.0) for n in law.names])
        friction[joint] = law
    files = []
    for run in range(2):
        path = tmp_path / f"run_{run}.parquet"
        options = {"seconds": 30.0, "rate": 50.0, "noise": 0.01}
        simulate_robot(robot, friction, seed=10 * seed + run, **options).write_parquet(path)
        files.append(str(path))
    reading = ReadOptions(map=[f"{channel}={column}" for channel, column in COLUMNS])
    found = improve_robot(read_motion(robot, files, reading), most_steps=1)
    added = {joint: [step.finding.effect for step in steps] for joint, steps in found.steps.items()}
    assert added == {joint: [effect] if joint == name else [] for joint in robot.names}
    assert found.rigid_body == ()
