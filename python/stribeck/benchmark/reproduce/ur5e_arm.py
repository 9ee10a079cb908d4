"""Energies and errors of joint 2 (tables 4 to 6) on synthetic arms like a UR5e.

The review prints no parameters of the other joints. The arms of `stribeck generate` have the
kinematics and masses of a UR5e; their friction is none of the laws, so that every law leaves an
error, as on the review's robot.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.benchmark.reproduce.result import Row
from stribeck.benchmark.reproduce.ur5e_tables import JOINT_2, Errors, Table
from stribeck.fitting.energy import electrical_energy, total_energy
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search.effort import THOROUGH
from stribeck.motion.generate.ur5e import JOINTS, RobotRecording
from stribeck.recording.load import read
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Held-out blocks are predicted by the linearised model, as in a study.
EFFORT = replace(THOROUGH, exact=False)
#: Starts of each fit, and seeds of the arms: friction, way points and noise.
STARTS, ARMS = 2, 4
#: Cycles between two that are recorded while the arm warms up, of ninety.
EVERY = 22


@dataclass(frozen=True)
class OnArm:
    """A law fitted to all joints of one arm: energy error [%] and errors of joint 2 [N m, n]."""

    percent: float
    error: Array


def arm_rows(tables: Sequence[Table], seed: int, arms: int = ARMS) -> list[Row]:
    """Rows of all tables: percentages of the energy, and joint 2."""
    rows: list[Row] = []
    for table in tables:
        found = [_on_arm(table, seed + k) for k in range(arms)]
        for law, line in table.lines.items():
            rows += _rows(table, law, line, [each[law] for each in found])
    return rows


def _on_arm(table: Table, seed: int) -> dict[str, OnArm]:
    """Every law of a table on every joint of one arm."""
    recordings = _recordings(table, seed)
    return {law: _judged([_fitted(law, r) for r in recordings]) for law in table.lines}


def _recordings(table: Table, seed: int) -> list[Recording]:
    """All joints: one cycle, or five of ninety where the law reads the temperature."""
    warming = table.number == 5
    arm = RobotRecording(
        test=table.test,
        seed=seed,
        repeats=90 if warming else 1,
        every=EVERY if warming else 1,
        rate=5.0 if warming else 50.0,
    )
    made = []
    for drive, joint in zip(arm.drives, JOINTS, strict=True):
        motor = drive.motor
        frame = pl.concat(arm.cycles(joint)).drop("joint")
        made.append(
            read(
                frame,
                joint_kind="revolute",
                gear_ratio=motor.gear_ratio,
                torque_constant=motor.kt,
                km=motor.km,
                kb=motor.kb,
                kt=motor.kt,
                rows="all",
            )
        )
    return made


def _fitted(law: str, recording: Recording) -> Fit:
    # A parameter that the motion does not determine has no finite variance.
    with np.errstate(over="ignore", invalid="ignore"):
        return fit(law, recording, starts=STARTS, effort=EFFORT)


def _judged(fits: Sequence[Fit]) -> OnArm:
    total = total_energy(electrical_energy(f.recording, f.prediction) for f in fits)
    assert total is not None, "the arms have motor constants"
    return OnArm(total.error_percent, fits[1].recording.torque - fits[1].prediction)


def _rows(table: Table, law: str, line: Errors, found: Sequence[OnArm]) -> Iterable[Row]:
    """The percentage of the energy, and mean and standard deviation of joint 2."""
    why = (
        "mean over synthetic arms whose friction is no law of the catalog; three times their "
        "scatter and half a unit of the last digit. The review's robot is one more draw, if it is "
        "alike"
    )
    mean, std = JOINT_2[law]
    for quantity, unit, paper, ours in (
        ("energy error", "%", line.percent, [one.percent for one in found]),
        ("joint 2, mean", "N m", mean, [float(one.error.mean()) for one in found]),
        ("joint 2, std", "N m", std, [float(one.error.std()) for one in found]),
    ):
        allowed = 3.0 * float(np.std(ours, ddof=1)) + 0.005
        where = f"table {table.number}, arm"
        yield Row(where, f"{law}, {quantity}", unit, paper, float(np.mean(ours)), allowed, why)
