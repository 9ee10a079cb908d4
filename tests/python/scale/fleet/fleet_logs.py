"""Logs of a fleet made with numpy alone: some robots, two joints each, one file a day."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
from synthetic import motion

JOINTS = ("elbow", "wrist")
#: The joint that wears by `WEAR` from `WORN_FROM` on, and the one with a Stribeck curve.
WORN, WORN_FROM, WEAR = ("r2", "elbow"), 7, 1.2
WITH_STRIBECK = ("r3", "wrist")


def joint_log(
    rng: np.random.Generator, coulomb: float, viscous: float, stribeck: float, rows: int
) -> pl.DataFrame:
    """One joint of one day, with its inertial torque known."""
    t, q, v, a = motion(rows)
    friction = np.sign(v) * (coulomb + stribeck * np.exp(-np.abs(v) / 0.1)) + viscous * v
    return pl.DataFrame(
        {
            "time": t,
            "position_rad": q,
            "velocity": v + 1e-4 * rng.standard_normal(rows),
            "acceleration": a,
            "load_torque": 0.3 * a,
            "torque": 0.3 * a + friction + 0.05 * rng.standard_normal(rows),
        }
    )


def write_logs(
    folder: Path, *, robots: int = 3, days: int = 8, scatter: float = 0.02, rows: int = 600
) -> list[Path]:
    """``rN/2026-03-DD.parquet`` of each robot and day; friction scatters from day to day."""
    rng = np.random.default_rng(0)
    paths = []
    for robot in (f"r{k}" for k in range(1, robots + 1)):
        (folder / robot).mkdir(parents=True)
        usual = {joint: rng.uniform([2.0, 0.8], [4.0, 1.5]) for joint in JOINTS}
        for day in range(1, days + 1):
            logs = []
            for joint in JOINTS:
                coulomb, viscous = usual[joint] * (1.0 + scatter * rng.standard_normal(2))
                if (robot, joint) == WORN and day >= WORN_FROM:
                    coulomb, viscous = WEAR * coulomb, WEAR * viscous
                stribeck = 1.0 if (robot, joint) == WITH_STRIBECK else 0.0
                log = joint_log(rng, coulomb, viscous, stribeck, rows)
                logs.append(log.with_columns(joint=pl.lit(joint)))
            paths.append(folder / robot / f"2026-03-{day:02d}.parquet")
            pl.concat(logs).write_parquet(paths[-1])
    return paths


def command(*words: object, timeout: float = 300.0) -> subprocess.CompletedProcess[str]:
    """`stribeck fleet` as a user runs it."""
    return subprocess.run(
        [sys.executable, "-m", "stribeck", "fleet", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=timeout,
    )


def answers(folder: Path) -> pl.DataFrame:
    """The data set in a folder, without what may differ from run to run."""
    return pl.read_parquet(folder / "results" / "*.parquet").drop("seconds")
