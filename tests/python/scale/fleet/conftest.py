"""A small fleet's logs, and what one model says of them."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import stribeck as sb
from fleet_logs import write_logs
from stribeck.scale.fleet.changes import Question


@pytest.fixture(scope="session")
def logs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Three robots, two joints, eight days."""
    return write_logs(tmp_path_factory.mktemp("logs"))


@pytest.fixture(scope="session")
def fitted(logs: list[Path], tmp_path_factory: pytest.TempPathFactory) -> sb.Fleet:
    """`coulomb` on all of them; days 7 and 8 are new."""
    folder = tmp_path_factory.mktemp("fitted") / "fleet"
    question = Question(window=2)
    with ThreadPoolExecutor(1) as executor:
        return sb.fleet(logs, folder, "coulomb", executor=executor, question=question)
