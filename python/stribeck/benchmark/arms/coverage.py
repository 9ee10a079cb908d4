"""Whether the 95 % intervals of a simulated arm hold the truth, and its links are possible."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.benchmark.arms.arm import ArmMotion, draw_arm, draw_friction
from stribeck.benchmark.arms.cases import ArmCase
from stribeck.benchmark.arms.record import CENTRE, point_mass
from stribeck.benchmark.draws import log_uniform
from stribeck.benchmark.open_loop.joint import SimulatedJoint
from stribeck.benchmark.open_loop.record import coloured_noise
from stribeck.robot.arm import Robot
from stribeck.robot.consistent import pseudo_inertia

Array = NDArray[np.float64]

#: A light arm: joints, duration of a run, s, and samples per second, Hz.
JOINTS, SECONDS, RATE = 3, 40.0, 50.0


@dataclass(frozen=True)
class ArmIntervals:
    """How many 95 % intervals hold the truth.

    Attributes
    ----------
    base, friction
        Numbers of parameters whose interval holds the truth, and of all.
    payload
        Whether that of the payload's mass does.
    possible
        Whether the pseudo-inertia of every link is positive definite.
    """

    base: tuple[int, int]
    friction: tuple[int, int]
    payload: bool
    possible: bool


def arm_intervals(case: ArmCase) -> ArmIntervals:
    """Identify an arm whose friction is exactly Coulomb and viscous; its last run has a payload."""
    from stribeck.recording.stated.options import ReadOptions
    from stribeck.robot.fit import fit_robot
    from stribeck.robot.motion import read_motion
    from stribeck.robot.simulate import COLUMNS

    random = np.random.default_rng(case.seed)
    reading = ReadOptions(map=[f"{channel}={column}" for channel, column in COLUMNS])
    robot = draw_arm(random, JOINTS)
    friction = [draw_friction(random, k + 1, ()) for k in range(JOINTS)]
    mass = log_uniform(random, 0.5, 3.0)
    bodies = np.array([[*np.array(joint.inertial), joint.rotor] for joint in robot.joints])
    carried = bodies.copy()
    carried[-1, :10] += mass * point_mass(CENTRE)
    arms = (robot, robot.with_bodies(carried))
    with tempfile.TemporaryDirectory(prefix="stribeck-benchmark-") as folder:
        files = [str(Path(folder) / f"{name}.parquet") for name in ("empty", "carries")]
        for path, arm in zip(files, arms, strict=True):
            _run(random, arm, friction).write_parquet(path)
        found = fit_robot(read_motion(robot, files, reading), payload=("carries",))
    true = found.solved.balance.base.mapping @ bodies.ravel()
    base = [
        bool(row.ci95[0] <= x <= row.ci95[1])
        for row, x in zip(found.base_parameters, true, strict=True)
    ]
    covered = []
    for joint, own in zip(found.joints, friction, strict=True):
        truth = {"coulomb_friction": own.coulomb, "viscous_friction": own.viscous, "offset": 0.0}
        for name, estimate in joint.estimates.items():
            low, high = estimate.ci95 or (np.nan, np.nan)
            covered.append(bool(low <= truth[name] <= high))
    low, high = (np.nan, np.nan) if found.payload is None else found.payload.mass_ci95
    return ArmIntervals(
        (sum(base), len(base)),
        (sum(covered), len(covered)),
        bool(low <= mass <= high),
        all(
            linear.symmetric_eigen(pseudo_inertia(row[:10]))[0].min() > 0.0
            for row in found.bodies.parameters
        ),
    )


def _run(random: np.random.Generator, robot: Robot, joints: list[SimulatedJoint]) -> pl.DataFrame:
    """A recording of an arm with Coulomb and viscous friction."""
    t = np.arange(round(SECONDS * RATE)) / RATE
    q, v, a = ArmMotion.draw(random, joints, SECONDS, ())(t)
    load = robot.torque(q, v, a)
    columns = {"time": t}
    for k, own in enumerate(joints):
        noise = own.coulomb * log_uniform(random, 0.015, 0.05)
        torque = load[:, k] + own.coulomb * np.sign(v[:, k]) + own.viscous * v[:, k]
        measured = v[:, k] + own.vmax * log_uniform(random, 1e-4, 4e-4) * random.standard_normal(
            t.size
        )
        name = robot.names[k]
        columns |= {
            f"position_{name}": q[:, k],
            f"velocity_{name}": measured,
            f"torque_{name}": torque + noise * coloured_noise(random, t.size),
        }
    return pl.DataFrame(columns)
