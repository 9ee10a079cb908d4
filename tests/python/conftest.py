"""What tests of several folders share; `synthetic` beside this file makes their recordings."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import stribeck as sb
from synthetic import joint, record


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the tests that take minutes: no processor waits for them in the end."""
    items.sort(key=lambda item: item.get_closest_marker("minutes") is None)


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
