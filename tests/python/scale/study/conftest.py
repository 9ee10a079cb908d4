"""Two joints with simple friction, and commands run as a user runs them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from synthetic import joint, motion

LAWS = ("coulomb", "bittencourt_a", "lugre")


def command(*words: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """`stribeck study` as a user runs it."""
    return subprocess.run(
        [sys.executable, "-m", "stribeck", "study", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        cwd=cwd,
    )


@pytest.fixture(scope="session")
def two_joints(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file of two joints with a Stribeck curve, and their motors in the sidecar."""
    v = motion(1500)[2]
    frames = [
        joint(size * np.sign(v) * np.exp(-np.abs(v) / 0.1), rows=1500, seed=seed).with_columns(
            joint=pl.lit(name)
        )
        for name, size, seed in (("near", 1.5, 1), ("far", 0.5, 2))
    ]
    path = tmp_path_factory.mktemp("joints") / "two.parquet"
    pl.concat(frames).write_parquet(path)
    path.with_name("two.parquet.sidecar.toml").write_text(
        'kind = "recording"\njoint_kind = "revolute"\ngear_ratio = 100.0\n'
        "[joints.near]\nkm = 0.1\nkb = 0.1\nkt = 0.1\n"
        "[joints.far]\nkm = 0.05\nkb = 0.06\nkt = 0.05\n"
    )
    return path
