"""Files in a row: order, runs, blocks, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.runs import block_edges, run_starts
from stribeck.scale.streaming.sample import stretches
from synthetic import joint


def parts(folder: Path, *frames: pl.DataFrame) -> Path:
    folder.mkdir(exist_ok=True)
    for k, frame in enumerate(frames):
        frame.write_parquet(folder / f"part_{k}.parquet", row_group_size=300)
    return folder


def test_rows_are_counted_through_all_files(tmp_path: Path) -> None:
    frame = joint(rows=2000)
    folder = parts(tmp_path / "set", frame[:700], frame[700:701], frame[701:])
    data = DataSet.open(folder)
    assert data.rows == 2000
    assert data.frame(650, 900).equals(frame[650:900])
    assert data.place(700) == "row 1 of part_1.parquet"


def test_a_pattern_takes_the_files_it_names(tmp_path: Path) -> None:
    frame = joint(rows=2000)
    folder = parts(tmp_path / "set", frame[:1000], frame[1000:])
    assert DataSet.open(f"{folder}/part_1*").rows == 1000


def test_a_clock_that_starts_again_begins_a_run(tmp_path: Path) -> None:
    frame = joint(rows=3000)
    again = frame.with_columns(pl.col("time") - 15.0)
    folder = parts(tmp_path / "set", frame[:1500], again[1500:], frame[:10])
    data = DataSet.open(folder)
    assert run_starts(data, None, "time").tolist() == [0, 1500, 3000]
    fitted = sb.stream(folder, window_rows=400).fit("coulomb")
    assert any("the clock starts again in 2 files" in note for note in fitted.to_dict()["notes"])


def test_blocks_are_whole_runs_where_there_are_five() -> None:
    assert block_edges(1000, np.array([0])).tolist() == list(range(0, 1001, 100))
    starts = np.array([0, 90, 330, 520, 900])
    assert set(block_edges(1000, starts)) <= {0, 90, 330, 520, 900, 1000}


def test_stretches_lie_each_in_its_own_share() -> None:
    taken = stretches(10_000_000, 200_000, seed=3)
    assert len(taken) == 40
    for k, (begin, end) in enumerate(taken):
        assert end - begin == 5000
        assert k * 250_000 <= begin and end <= (k + 1) * 250_000
    assert taken != stretches(10_000_000, 200_000, seed=4)


def test_rows_without_a_number_are_gaps(tmp_path: Path) -> None:
    frame = joint(rows=6000).with_columns(
        torque=pl.when(pl.int_range(pl.len()) % 97 == 5).then(None).otherwise(pl.col("torque"))
    )
    fitted = sb.stream(parts(tmp_path / "set", frame), window_rows=512).fit("coulomb")
    assert fitted.dropped == frame["torque"].null_count()
    assert fitted.rows == 6000 - fitted.dropped


def test_dates_are_counted_from_the_first_row(tmp_path: Path) -> None:
    frame = joint(rows=3000)
    start = pl.datetime(2024, 5, 1, time_unit="us")
    dated = frame.with_columns(time=start + pl.duration(microseconds=pl.col("time") * 1e6))
    folder = parts(tmp_path / "set", dated[:1000], dated[1000:])
    fitted = sb.stream(folder, window_rows=700).fit("coulomb+drift", starts=1)
    assert fitted.time_span == pytest.approx((0.0, frame["time"][-1]))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ("backwards", r'row 202 of part_1.parquet: time goes from .* `map="run=COLUMN"`'),
        ("columns", r"part_1.parquet: its columns differ from those of .*position"),
        ("damaged", r"part_1.parquet: is not a complete Parquet file .*: write or copy it again"),
        ("empty", r"there are no Parquet files in this folder"),
    ],
)
def test_what_cannot_be_read_is_said_in_one_line(
    tmp_path: Path, change: str, sentence: str
) -> None:
    frame = joint(rows=2000)
    second = frame[1000:]
    folder = tmp_path / "set"
    if change == "backwards":
        second = pl.concat([second[:200], second[201], second[200], second[202:]])
    if change == "columns":
        second = second.drop("position")
    folder = parts(folder, frame[:1000], second)
    if change == "damaged":
        whole = (folder / "part_1.parquet").read_bytes()
        (folder / "part_1.parquet").write_bytes(whole[: len(whole) // 2])
    if change == "empty":
        for file in folder.iterdir():
            file.unlink()
    with pytest.raises(sb.RecordingError, match=sentence) as raised:
        sb.stream(folder, sample_rows=400, window_rows=512).fit("coulomb")
    assert "\n" not in str(raised.value)


def test_what_needs_all_rows_at_once_is_refused(tmp_path: Path) -> None:
    folder = parts(tmp_path / "set", joint(rows=2000))
    with pytest.raises(sb.RecordingError, match='`average="run"` needs all samples in memory'):
        sb.stream(folder, average="run")
