"""The servo's recordings, made once."""

from __future__ import annotations

import polars as pl
import pytest
import stribeck as sb
from servo_recording import recorded, servo


@pytest.fixture(scope="session")
def frame() -> pl.DataFrame:
    """Driven runs and releases."""
    return servo()


@pytest.fixture(scope="session")
def whole(frame: pl.DataFrame, tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """Rows with the servo on and off."""
    return recorded(tmp_path_factory.mktemp("whole"), frame)


@pytest.fixture(scope="session")
def driven(frame: pl.DataFrame, tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """Rows with the servo on."""
    return recorded(tmp_path_factory.mktemp("driven"), frame, where="enabled")
