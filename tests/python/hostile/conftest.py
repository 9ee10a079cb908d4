"""The folder in which hostile rows run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from hostile.contract import make_workspace


@pytest.fixture(scope="session")
def _made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    make_workspace(folder)
    return folder


@pytest.fixture
def workspace(_made: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The working folder of a row."""
    monkeypatch.chdir(_made)
    yield _made
