"""What tests of several folders share; `synthetic` beside this file makes their recordings."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from synthetic import joint, record


@pytest.fixture(scope="session")
def plain(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with Coulomb and viscous friction and nothing else."""
    return record(tmp_path_factory.mktemp("plain"), joint())


@pytest.fixture(scope="session")
def plain_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same joint as a CSV file, for the command line."""
    path = tmp_path_factory.mktemp("file") / "joint.csv"
    joint(rows=1500).write_csv(path)
    return path
