"""One improvement, made once, that text, figures and pages are shown of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.motion.generate.hidden import generate
from stribeck.recording.stated.options import ReadOptions
from stribeck.robot.motion import RobotMotion, read_motion
from stribeck.robot.simulate import COLUMNS, simulate_robot
from stribeck.robot.tables import from_tables


@pytest.fixture(scope="session")
def improvement(tmp_path_factory: pytest.TempPathFactory) -> sb.Improvement:
    frame, _ = generate(["load"], seed=1, seconds=60.0, rate=50.0, noise=0.03, warming=2.0)
    path: Path = tmp_path_factory.mktemp("report") / "made <&> odd.parquet"
    frame.write_parquet(path)
    return sb.improve("coulomb", sb.read(path, joint_kind="revolute"), starts=5)


@pytest.fixture(scope="session")
def diagnosis(improvement: sb.Improvement) -> sb.Diagnosis:
    """What the base of the improvement lacks."""
    return sb.diagnose(improvement.base)


@pytest.fixture(scope="session")
def steady(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """A fit to steady-state points: no time, few rows, no position."""
    import polars as pl

    v = np.repeat(np.concatenate([np.linspace(0.05, 2, 12), np.linspace(-2, -0.05, 12)]), 3)
    noise = np.random.default_rng(0).standard_normal(v.size)
    path: Path = tmp_path_factory.mktemp("steady") / "points.csv"
    pl.DataFrame(
        {
            "run": np.repeat(np.arange(24), 3),
            "time": np.tile([0.0, 0.1, 0.2], 24),
            "velocity": v + 1e-5 * noise,
            "torque": 3 * np.sign(v) + 2 * v + 0.02 * noise,
            "load_torque": np.zeros(v.size),
        }
    ).write_csv(path)
    return sb.fit("coulomb", sb.read(path, joint_kind="revolute", average="run"))


@pytest.fixture(scope="session")
def motion(tmp_path_factory: pytest.TempPathFactory) -> RobotMotion:
    """A planar arm, simulated."""
    tip = [2.0, 0.6, 0.0, 0.0, 0.01, 0.0, 0.25, 0.0, 0.0, 0.25, 0.1]
    bare = from_tables("planar", [{"a": 0.5}, {"a": 0.5}], gravity=(0.0, -9.81, 0.0))
    arm = bare.with_bodies(np.array([tip, tip]))
    law = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=1.0)
    path = tmp_path_factory.mktemp("run") / "run.parquet"
    made = simulate_robot(arm, dict.fromkeys(arm.names, law), seconds=15.0, rate=50.0, noise=0.01)
    made.write_parquet(path)
    reading = ReadOptions(map=[f"{channel}={column}" for channel, column in COLUMNS])
    return read_motion(arm, [str(path)], reading)
