"""Synthetic joints written to small files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT.parent / "shared" / "data"
CASES = ROOT.parent / "shared" / "cases"
SIDECARS = ROOT / "tests" / "sidecars"


def joint(
    rows: int = 2000, rate: float = 200.0, noise: float = 1e-3, seed: int = 1
) -> pl.DataFrame:
    """A revolute joint on two sines with Coulomb and viscous friction."""
    rng = np.random.default_rng(seed)
    t = np.arange(rows) / rate
    w1, w2 = 2 * np.pi * 0.4, 2 * np.pi * 0.9
    q = 0.8 * np.sin(w1 * t) + 0.2 * np.sin(w2 * t)
    v = 0.8 * w1 * np.cos(w1 * t) + 0.2 * w2 * np.cos(w2 * t)
    a = -0.8 * w1**2 * np.sin(w1 * t) - 0.2 * w2**2 * np.sin(w2 * t)
    load = 0.5 * a + 3.0 * np.cos(q)
    tau = load + 2.0 * np.sign(v) + 1.5 * v
    return pl.DataFrame(
        {
            "time": t,
            "position": q,
            "velocity": v + noise * rng.standard_normal(rows),
            "acceleration": a,
            "torque": tau + 0.05 * rng.standard_normal(rows),
            "load_torque": load,
            "temperature": 25.0 + t,
        }
    )


@pytest.fixture
def frame() -> pl.DataFrame:
    return joint()


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    """Write a frame (or text, or bytes) to a file of the test's directory."""

    def _write(content: Any, name: str = "data.parquet") -> Path:
        path = tmp_path / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        elif isinstance(content, str):
            path.write_text(content, encoding="utf-8")
        elif name.endswith((".csv", ".txt")):
            content.write_csv(path)
        elif name.endswith(".tsv"):
            content.write_csv(path, separator="\t")
        else:
            content.write_parquet(path)
        return path

    return _write
