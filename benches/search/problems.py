"""The fits of the UR5e study: 25 laws, six joints, two motions."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import stribeck as sb
from numpy.typing import NDArray
from stribeck.fitting.fit import rows_to_fit
from stribeck.identify.left_out.transients import transient_rows
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.ends import Found
from stribeck.identify.search.many_starts import multi_start
from stribeck.scale.study.plan import REVIEW

#: Motions of the robot, and every how many cycles of the motion are recorded.
MOTIONS = {1: 1, 2: 30}
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")


@dataclass(frozen=True)
class Case:
    """One law on one joint in one motion."""

    motion: int
    joint: str
    law: str

    @property
    def name(self) -> str:
        """The case in the table of optima."""
        return f"{self.motion}/{self.joint}/{self.law}"


def cases(laws: tuple[str, ...] = REVIEW, motions: tuple[int, ...] = (1, 2)) -> Iterator[Case]:
    """All cases, motion by motion and joint by joint."""
    for motion in motions:
        for joint in JOINTS:
            yield from (Case(motion, joint, law) for law in laws)


def recording_file(folder: Path, motion: int) -> Path:
    """The recording of a motion, made where it is missing."""
    path = folder / f"ur5e_{motion}.parquet"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        options = ["--robot", "ur5e", "--test", str(motion), "--every", str(MOTIONS[motion])]
        command = [sys.executable, "-m", "stribeck", "generate", *options, "-o", str(path)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return path


@lru_cache(maxsize=1)
def recording(folder: Path, motion: int, joint: str) -> tuple[sb.Recording, NDArray[np.bool_]]:
    """A joint's recording, and its samples that are not fitted."""
    read = sb.read(recording_file(folder, motion), joint=joint)
    return read, transient_rows(read)


def found(folder: Path, case: Case, effort: Effort, *, starts: int, seed: int) -> Found:
    """Search the minimum of a case as `stribeck.fit` does."""
    problem = problem_of(folder, case)
    lower, upper, first = bounds(problem.model, problem.recording)
    every = np.ones(first.size, dtype=bool)
    return multi_start(problem, lower, upper, first, every, starts, seed, effort)


def problem_of(folder: Path, case: Case) -> Problem:
    """The least-squares problem of a case."""
    read, marked = recording(folder, case.motion, case.joint)
    model = model_for(case.law, read)
    return Problem(read, model, rows_to_fit(model, read, marked))


def error_of(folder: Path, case: Case, square: float) -> float:
    """The RMSE over the fitted samples."""
    return float(np.sqrt(square / problem_of(folder, case).rows.size))
