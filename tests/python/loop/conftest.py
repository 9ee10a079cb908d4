"""Slow and long cases run only when asked for: ``pytest -m "slow or not slow"``."""

from __future__ import annotations

from pathlib import Path

import pytest

ASKED = ("slow", "long")


def pytest_configure(config: pytest.Config) -> None:
    """Register the markers, wherever pytest is started from."""
    for name in ASKED:
        config.addinivalue_line("markers", f"{name}: takes long; runs only with -m")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Skip the slow cases of this folder unless -m is given."""
    if config.getoption("markexpr"):
        return
    skip = pytest.mark.skip(reason='slow: pytest -m "slow or not slow"')
    for item in items:
        asked = any(item.get_closest_marker(name) for name in ASKED)
        if Path(__file__).parent in item.path.parents and asked:
            item.add_marker(skip)
