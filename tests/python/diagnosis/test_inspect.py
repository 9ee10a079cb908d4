"""What is in a file, and what it can show."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from stribeck.base.errors import RecordingError
from stribeck.diagnosis.inspect import inspect
from stribeck.models.catalog import effect_ids
from synthetic import joint


def write(folder: Path, frame: pl.DataFrame, name: str = "made.csv") -> str:
    """Write a frame as CSV."""
    path = folder / name
    frame.write_csv(path)
    return str(path)


def test_contract_keys(tmp_path: Path) -> None:
    frame = joint(rows=1500)
    answer = json.loads(json.dumps(inspect(write(tmp_path, frame)).to_dict()))
    assert {
        "rows",
        "joints",
        "runs",
        "columns",
        "rate_hz",
        "gaps",
        "testable",
        "untestable",
    } <= set(answer)
    assert answer["rows"] == 1500 and answer["runs"] == 1 and answer["gaps"] == 0
    assert answer["rate_hz"] == pytest.approx(100.0)
    for name, column in answer["columns"].items():
        assert {"from", "unit", "min", "max"} <= set(column), name
    for name in frame.columns:
        column = answer["columns"][name]
        assert column["from"] == name
        assert column["min"] == pytest.approx(frame[name].min())
        assert column["max"] == pytest.approx(frame[name].max())
    assert answer["columns"]["torque"]["unit"] == "N m"


def test_testable_and_untestable_are_all_effects(tmp_path: Path) -> None:
    answer = inspect(write(tmp_path, joint(rows=1500).drop("temperature"))).to_dict()
    cannot = {row["effect"] for row in answer["untestable"]}
    assert cannot == {"temperature_viscous", "temperature_dry", "thermometer_lag"}
    assert set(answer["testable"]) | cannot == set(effect_ids())
    assert not set(answer["testable"]) & cannot
    for row in answer["untestable"]:
        assert set(row) == {"effect", "why", "do"} and row["why"] and row["do"]


def test_gaps_and_runs_are_counted(tmp_path: Path) -> None:
    frame = joint(rows=1500)
    holes = frame.filter(~pl.col("time").is_between(4.0, 4.5) & ~pl.col("time").is_between(8, 8.2))
    assert inspect(write(tmp_path, holes)).to_dict()["gaps"] == 2
    runs = frame.with_columns(run=pl.Series(np.arange(1500) // 500))
    assert inspect(write(tmp_path, runs)).to_dict()["runs"] == 3


def test_load_of_an_identified_rigid_body_counts(tmp_path: Path) -> None:
    answer = inspect(write(tmp_path, joint(rows=1500).drop("load_torque"))).to_dict()
    assert "load" in answer["testable"] + [r["effect"] for r in answer["untestable"]]


def test_several_joints_are_all_looked_at(tmp_path: Path) -> None:
    frame = joint(rows=1500)
    both = pl.concat(
        [
            frame.with_columns(joint=pl.lit("hip")),
            frame.with_columns(joint=pl.lit("knee"), temperature=pl.lit(20.0)),
        ]
    )
    path = write(tmp_path, both)
    answer = inspect(path).to_dict()
    assert answer["joints"] == ["hip", "knee"] and answer["rows"] == 3000
    # What one of them can show the file can show.
    assert answer["untestable"] == []
    knee = inspect(path, joint="knee").to_dict()
    thermal = {"temperature_viscous", "temperature_dry", "thermometer_lag"}
    assert {r["effect"] for r in knee["untestable"]} == thermal


def test_a_file_that_is_no_recording_yet_is_still_shown(tmp_path: Path) -> None:
    answer = inspect(write(tmp_path, joint(rows=300).drop("torque"))).to_dict()
    assert "torque" in answer["problem"] and answer["testable"] == []
    assert answer["rows"] == 300 and "velocity" in answer["problem"]


@pytest.mark.parametrize(
    "wrong", [{"map": "velocity=nope"}, {"unit": "velocity=furlong"}, {"weights": "nope"}]
)
def test_an_option_that_cannot_be_followed_is_refused(
    tmp_path: Path, wrong: dict[str, str]
) -> None:
    with pytest.raises(RecordingError, match=next(iter(wrong.values()))):
        inspect(write(tmp_path, joint(rows=300)), **wrong)  # type: ignore[arg-type]
