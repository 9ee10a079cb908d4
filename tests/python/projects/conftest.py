"""A project of a joint with a load dependence, walked once; tests branch off from its steps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from synthetic import joint, motion


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a recording in a folder below it."""
    made = tmp_path_factory.mktemp("project")
    (made / "data").mkdir()
    load, v = joint(rows=2000)["load_torque"].to_numpy(), motion(2000)[2]
    frame = joint(0.15 * np.abs(load) * np.sign(v), rows=2000, noise=0.05)
    frame.write_csv(made / "data" / "joint.csv")
    return made


@pytest.fixture(scope="session")
def begun(folder: Path) -> sb.Project:
    """The base alone."""
    return sb.Project.new(
        folder / "joint.toml",
        folder / "data" / "joint.csv",
        "coulomb",
        joint_kind="revolute",
        map=["torque=torque"],
    )


@pytest.fixture(scope="session")
def diagnosed(begun: sb.Project) -> sb.Project:
    """The base with its findings."""
    return begun.diagnose()


@pytest.fixture(scope="session")
def branched(diagnosed: sb.Project) -> sb.Project:
    """Two branches of the base: load, rightly, and offset, named a guess."""
    guess = diagnosed.add("offset", starts=2).named("guess")
    return guess.back().add("load", starts=2).reject("inertia", 'known "from CAD"')
