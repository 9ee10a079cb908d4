"""Batches that end where the joint turns round or rests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import stribeck as sb
from stribeck.identify.instrumental.exogeneity import stroke_batches


def test_batches_are_strokes(tmp_path: Path) -> None:
    time = np.arange(0.0, 60.0, 0.01)
    path = tmp_path / "sine.parquet"
    velocity = np.cos(np.pi * time)
    frame = {"time": time, "velocity": velocity, "torque": np.sign(velocity)}
    pl.DataFrame(frame).write_parquet(path)
    made = sb.read(path)
    rows = np.flatnonzero(made.moving)
    residual = np.random.default_rng(0).normal(size=rows.size)
    batch = stroke_batches(made, rows, residual)
    direction = np.sign(velocity[rows])
    changes = np.flatnonzero(np.diff(batch))
    assert 50 <= batch.max() + 1 <= 61
    assert np.all(direction[changes] != direction[changes + 1])
    # One long stroke is divided into batches of equal length.
    one_way = stroke_batches(made, rows[:60], residual[:60])
    assert np.ptp(np.bincount(one_way)) <= 1 and one_way.max() + 1 >= 10
