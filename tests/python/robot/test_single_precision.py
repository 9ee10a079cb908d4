"""Torques of rigid bodies in single precision."""

from __future__ import annotations

from pathlib import Path

import arms
import numpy as np
import pytest
from stribeck.robot.urdf import read_urdf


@pytest.mark.parametrize("name", arms.KINDS)
def test_single_precision_is_close_to_double(name: str, tmp_path: Path) -> None:
    """Motions are exact in both; what differs is rounding: 1.2e-7 an operation."""
    path = tmp_path / "arm.urdf"
    path.write_text(arms.urdf(name))
    core = read_urdf(path).core
    motion = [x.astype(np.float32).astype(np.float64) for x in arms.states(name, 1000)]
    double = core.inverse_dynamics(*motion)
    single = core.inverse_dynamics(*motion, single=True)
    assert np.array_equal(single, single.astype(np.float32))
    error = np.abs(single - double) / np.max(np.abs(double), axis=1, keepdims=True)
    assert 1e-8 < np.max(error) < 5e-6
