"""Causes found on stretches of a data set, and counted on all of it."""

from __future__ import annotations

import json
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.cli.main import cli
from synthetic import joint


@pytest.fixture(name="folder", scope="module")
def loaded_joint(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A joint whose friction grows with the load, in two files."""
    made = tmp_path_factory.mktemp("logs")
    frame = joint(rows=24_000).with_columns(
        torque=pl.col("torque") + 0.15 * pl.col("load_torque").abs() * pl.col("velocity").sign()
    )
    frame[:12_000].write_parquet(made / "a.parquet")
    frame[12_000:].write_parquet(made / "b.parquet")
    return made


@pytest.mark.slow
def test_what_is_missing_is_found_on_a_part_and_counted_on_all(folder: Path) -> None:
    opened = sb.stream(folder, sample_rows=8000)
    way = opened.improve("coulomb", most_steps=1)
    answer = way.to_dict()
    assert [step["effect"] for step in answer["steps"]] == ["load"]
    assert answer["data"]["rows"] == 24_000 and answer["data"]["rows_in_memory"] == 8000
    before, after = way.fits
    assert answer["steps"][0]["rmse_held_out_before"] == before.rmse_held_out
    assert answer["steps"][0]["rmse_held_out_after"] == after.rmse_held_out
    assert after.rmse_held_out == pytest.approx(0.03, rel=0.1)
    assert after.model.value("load_coulomb") == pytest.approx(0.15, rel=0.05)
    assert "8 000 samples: contiguous parts, spread over all 24 000" in repr(way)


@pytest.mark.slow
def test_the_command_says_what_was_looked_at(folder: Path) -> None:
    done = CliRunner().invoke(
        cli, ["diagnose", str(folder), "coulomb", "--stream", "--sample-rows", "8000", "--json"]
    )
    assert done.exit_code == 0, done.output
    answer = json.loads(done.stdout)
    assert answer["verdict"] == "missing"
    assert answer["findings"][0]["effect"] == "load"
    assert answer["findings"][0]["rmse_held_out_before"] == answer["rmse_held_out"]
    assert answer["scored"]["rows"] > 20_000 > answer["data"]["rows_in_memory"]
