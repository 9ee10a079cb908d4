"""The data set: what is done again and what is not, what is damaged, what is of something else."""

from __future__ import annotations

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import polars as pl
import pytest
import stribeck as sb
from fleet_logs import answers, write_logs
from stribeck.base.errors import StribeckError
from stribeck.base.pool import Stopped


@pytest.fixture
def two_days(tmp_path: Path) -> list[Path]:
    """One robot, two days."""
    return write_logs(tmp_path / "logs", robots=1, days=2)


def run(files: Any, folder: Path, model: str = "coulomb", **options: Any) -> sb.Fleet:
    with ThreadPoolExecutor(1) as executor:
        return sb.fleet(files, folder, model, executor=executor, **options)


def test_what_is_done_is_not_done_again(two_days: list[Path], tmp_path: Path) -> None:
    folder = tmp_path / "fleet"
    assert run(two_days[:1], folder).new == 2
    added = run(two_days, folder)
    assert added.new == 2 and added.rows.height == 4
    assert run(two_days, folder).new == 0
    assert [path.name for path in (folder / "results").iterdir()] == ["part-000003.parquet"]


def test_rows_are_the_same_whichever_way_they_came(two_days: list[Path], tmp_path: Path) -> None:
    at_once = run(two_days, tmp_path / "once")
    run(two_days[1:], tmp_path / "twice")
    run(two_days, tmp_path / "twice")
    assert answers(tmp_path / "once").equals(answers(tmp_path / "twice"))
    assert at_once.rows["day"].to_list() == sorted(at_once.rows["day"].to_list())


def test_a_file_that_changed_is_done_again(two_days: list[Path], tmp_path: Path) -> None:
    folder = tmp_path / "fleet"
    before = run(two_days, folder).rows
    log = pl.read_parquet(two_days[0])
    # One joint is gone, the other has more friction.
    log.filter(joint="elbow").with_columns(pl.col("torque") * 1.5).write_parquet(two_days[0])
    after = run(two_days, folder)
    assert after.new == 1 and after.rows.height == 3
    assert after.rows["model_file"][0] != before["model_file"][0]


def test_a_file_that_was_only_touched_is_not(two_days: list[Path], tmp_path: Path) -> None:
    run(two_days, tmp_path / "fleet")
    os.utime(two_days[0], (1.0, 1.0))
    assert run(two_days, tmp_path / "fleet").new == 0


def test_a_sidecar_that_changed_does_both_joints_again(
    two_days: list[Path], tmp_path: Path
) -> None:
    run(two_days, tmp_path / "fleet")
    two_days[0].with_name(f"{two_days[0].name}.sidecar.toml").write_text(
        'kind = "recording"\njoint_kind = "revolute"\n'
    )
    assert run(two_days, tmp_path / "fleet").new == 2


def test_failures_are_kept_until_they_are_asked_for(two_days: list[Path], tmp_path: Path) -> None:
    folder = tmp_path / "fleet"
    damaged = two_days[0].with_name("2026-03-03.parquet")
    damaged.write_bytes(b"PAR1 no more")
    files = [*two_days, damaged]
    found = run(files, folder)
    assert found.new == 5 and [f.file for f in found.failures] == [str(damaged)]
    assert run(files, folder).new == 0
    assert run(files, folder, retry_failed=True).new == 1
    shutil.copy(two_days[0], damaged)
    assert run(files, folder).new == 2
    assert run(files, folder).failures == ()


@pytest.mark.parametrize(
    ("model", "options", "sentence"),
    [
        ("bittencourt_a", {}, "another model"),
        ("coulomb", {"seed": 1}, r"another seed \(0 there, 1 here\)"),
        ("coulomb", {"joint_kind": "revolute"}, "other options"),
        ("coulomb", {"name": "{robot}/{day}.parquet"}, "with other names"),
    ],
)
def test_another_question_needs_another_folder(
    two_days: list[Path], tmp_path: Path, model: str, options: dict[str, Any], sentence: str
) -> None:
    run(two_days[:1], tmp_path / "fleet")
    with pytest.raises(StribeckError, match=sentence):
        run(two_days, tmp_path / "fleet", model, **options)


def test_a_folder_without_an_answer_is_left_free(two_days: list[Path], tmp_path: Path) -> None:
    folder = tmp_path / "fleet"
    with pytest.raises(StribeckError, match=r"in any of the 2 files.*no column 'vel'"):
        run(two_days, folder, map=["velocity=vel"])
    assert not folder.exists()
    assert run(two_days, folder).new == 4


def test_files_of_others_are_left_alone(two_days: list[Path], tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(StribeckError, match="is not empty"):
        run(two_days, tmp_path)
    damaged = tmp_path / "fleet" / "results" / "part-000009.parquet"
    run(two_days, tmp_path / "fleet")
    damaged.write_bytes(b"")
    with pytest.raises(StribeckError, match=r"part-000009.parquet is damaged"):
        run(two_days, tmp_path / "fleet")


def test_an_interrupt_keeps_what_is_done(two_days: list[Path], tmp_path: Path) -> None:
    def interrupt(done: int, total: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(Stopped):
        run(two_days, tmp_path / "fleet", progress=interrupt)
    assert answers(tmp_path / "fleet").height == 3
    assert run(two_days, tmp_path / "fleet").new == 1
