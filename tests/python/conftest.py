"""What tests of several folders share; `synthetic` beside this file makes their recordings."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from pathlib import Path

import pytest
import stribeck as sb
from synthetic import joint, record

BEGAN = time.monotonic()
#: Why a test was skipped for which no time was left.
NO_TIME = "no time is left"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The time that the tests may take."""
    parser.addoption("--seconds", type=float, help="Begin no test later than that.")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Begin with the tests that take minutes: no processor waits for them in the end.

    Where the time is limited, each commit has its own order of the files, so that all have a turn.
    """
    if config.getoption("seconds") is not None:
        items.sort(key=lambda item: sha256((_commit() + str(item.path)).encode()).digest())
    items.sort(key=lambda item: item.get_closest_marker("minutes") is None)


@cache
def _commit() -> str:
    """The commit of the checkout; empty where git does not know it."""
    command = ("git", "-C", Path(__file__).parent, "rev-parse", "HEAD")
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test for which no time is left."""
    limit = item.config.getoption("seconds")
    if limit is not None and time.monotonic() - BEGAN > limit:
        pytest.skip(NO_TIME)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how many tests were not begun."""
    skipped = terminalreporter.stats.get("skipped", [])
    left = sum(NO_TIME in str(report.longrepr) for report in skipped)
    if left:
        terminalreporter.write_line(f"{left} tests were not begun: {NO_TIME}")


@pytest.fixture(scope="session", autouse=True)
def no_result_is_kept() -> Iterator[None]:
    """Commands of the tests leave nothing in the cache of the user, in this process or others."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STRIBECK_LAST", "off")
        yield


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
