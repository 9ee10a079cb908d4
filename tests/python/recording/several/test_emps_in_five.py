"""EMPS cut into five files is EMPS in one file with a run column."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb

ROOT = Path(__file__).resolve().parents[4]
FILE = ROOT.parent / "shared" / "data" / "emps" / "emps.parquet"
SIDECAR = ROOT / "tests" / "sidecars" / "emps.sidecar.toml"

pytestmark = pytest.mark.skipif(not FILE.is_file(), reason="EMPS is not at ../shared/data")


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[sb.Recording, sb.Recording]:
    """The recording of one file with a run column, and of five files."""
    folder = tmp_path_factory.mktemp("emps")
    whole = pl.read_parquet(FILE)
    part = np.arange(whole.height) * 5 // whole.height
    whole.with_columns(pl.Series("run", part)).write_parquet(folder / "whole.parquet")
    (folder / "runs").mkdir()
    for k in range(5):
        whole.filter(pl.Series(part == k)).write_parquet(folder / "runs" / f"{k}.parquet")
    return (
        sb.read(folder / "whole.parquet", sidecar=SIDECAR),
        sb.read(folder / "runs", sidecar=SIDECAR),
    )


def close(one: float | None, other: float | None) -> bool:
    """Whether two figures agree to 1e-12 of their size."""
    assert one is not None and other is not None
    return abs(one - other) <= 1e-12 * abs(one)


def test_the_same_channels(pair: tuple[sb.Recording, sb.Recording]) -> None:
    one, five = pair
    assert one.run_names == five.run_names == ("0", "1", "2", "3", "4")
    for name in ("velocity", "acceleration", "torque", "moving", "block", "segment", "dt"):
        assert np.array_equal(getattr(one, name), getattr(five, name)), name


def test_the_same_fit_and_comparison(pair: tuple[sb.Recording, sb.Recording]) -> None:
    fits = [sb.fit("coulomb+direction", recording) for recording in pair]
    for name, e in fits[0].estimates.items():
        assert close(e.value, fits[1].estimates[name].value), name
        assert close(e.stderr, fits[1].estimates[name].stderr), name
    assert close(fits[0].rmse, fits[1].rmse)
    assert close(fits[0].rmse_held_out, fits[1].rmse_held_out)
    compared = [sb.compare([f], r) for f, r in zip(fits, pair, strict=True)]
    assert close(compared[0].noise_floor or 1.0, compared[1].noise_floor or 1.0)
    for one, five in zip(*(c.models[0].regimes for c in compared), strict=True):
        assert one.regime == five.regime and close(one.rmse, five.rmse)


@pytest.mark.slow
def test_the_same_first_step(pair: tuple[sb.Recording, sb.Recording]) -> None:
    one, five = (sb.improve("coulomb", recording, most_steps=1) for recording in pair)
    assert [s.finding.effect for s in one.steps] == [s.finding.effect for s in five.steps]
    assert one.steps
    assert close(one.final.rmse, five.final.rmse)
    assert close(one.final.rmse_held_out, five.final.rmse_held_out)
    for name, e in one.final.estimates.items():
        assert close(e.value, five.final.estimates[name].value), name
