"""The Parquet data set of a fleet: one row for each joint and file.

``manifest.json`` describes the work. ``results/`` is the data set: each row is written before its
task counts as done, in parts of some rows, each written atomically; the parts are merged at the
end. It can be read at any time: ``polars.read_parquet("FOLDER/results/*.parquet")``.
"""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import polars as pl

from stribeck.base.errors import StribeckError, option
from stribeck.base.files import write_bytes_whole
from stribeck.base.run_folder import MANIFEST, claim, unwritable
from stribeck.recording.stated.sidecar import sidecar_hash
from stribeck.scale.fleet.task import File, Task, TaskResult, Work

RESULTS = "results"
#: Rows of a part. The last part is written again with each row, so that none is lost.
ROWS_OF_PART = 32
#: What must be the same for all rows of a data set, and the words of the error if it is not.
IDENTITY = {
    "model": "with another model",
    "base": "from another base model",
    "name": "with other names of robots and days",
    "day_column": "with days from another column or from the paths",
    "starts": "with another number of starts",
    "seed": "with another seed",
    "reading": "of recordings read with other options",
    "choices": "with other bounds, starts or fixed values",
    "version": "made by another version of stribeck",
}
SCHEMA: dict[str, pl.DataType | type[pl.DataType]] = {
    "file": pl.String,
    "robot": pl.String,
    "joint": pl.String,
    "day": pl.Date,
    "status": pl.String,
    "reason": pl.String,
    "model": pl.String,
    "found": pl.List(
        pl.Struct({"effect": pl.String, "confidence": pl.Float64, "tied": pl.List(pl.String)})
    ),
    "rows": pl.Int64,
    "rows_scored": pl.Int64,
    "unit": pl.String,
    "rmse": pl.Float64,
    "rmse_held_out": pl.Float64,
    "noise_floor": pl.Float64,
    "converged": pl.Boolean,
    "parameters": pl.List(
        pl.Struct(
            {
                "name": pl.String,
                "symbol": pl.String,
                "unit": pl.String,
                "value": pl.Float64,
                "stderr": pl.Float64,
            }
        )
    ),
    "covariance": pl.List(pl.Float64),
    "model_file": pl.String,
    "notes": pl.List(pl.String),
    "seconds": pl.Float64,
    "size": pl.Int64,
    "modified": pl.Int64,
    "sha256": pl.String,
    "sidecar_sha256": pl.String,
    "joints_in_file": pl.Int64,
}
#: The columns that identify a row and the content of its files.
KEY, BYTES = ("file", "joint"), ("sha256", "sidecar_sha256")
DONE, FAILED = "done", "failed"


class FleetStore:
    """The folder of a fleet.

    Parameters
    ----------
    folder
        Created if it does not exist.
    work
        What is done with every joint.
    retry_failed
        Run failed tasks again.

    Attributes
    ----------
    frame : polars.DataFrame
        Every row, by file and joint; rows added later are included when the store is closed.

    Raises
    ------
    StribeckError
        The folder contains something else, or cannot be written to.
    """

    def __init__(self, folder: Path, work: Work, *, retry_failed: bool = False) -> None:
        self.folder = folder
        self._lock = claim(folder, _manifest(work), IDENTITY, "fleet's results")
        try:
            self._open_results(work, retry_failed)
        except BaseException:
            self._lock.release()
            raise

    def _open_results(self, work: Work, retry_failed: bool) -> None:
        """Read the rows of earlier runs."""
        folder = self.folder
        self._results = folder / RESULTS
        try:
            self._results.mkdir(exist_ok=True)
        except OSError as error:
            raise unwritable(folder, error) from None
        self._sidecar = work.reading.sidecar
        self._parts = sorted(self._results.glob("part-*.parquet"))
        self._new: list[dict[str, object]] = []
        self._open: Path | None = None
        self._added: list[pl.DataFrame] = []
        self.frame = _latest(_read(path) for path in self._parts)
        self._kept = self.frame.filter(pl.col("status") == DONE) if retry_failed else self.frame
        keys = self._kept.select("file", "joint", "sha256", "sidecar_sha256")
        self._answered = set(keys.iter_rows())

    def known(self, files: Iterable[File]) -> set[str]:
        """Return the paths that have a row for every joint and have not changed since."""
        of_file = self._kept.group_by("file").agg(
            pl.len() == pl.first("joints_in_file"), pl.first("size", "modified", "sidecar_sha256")
        )
        states = {path: tuple(state) for path, whole, *state in of_file.iter_rows() if whole}
        paths = (file.path for file in files)
        return {p for p in paths if p in states and states[p] == self._state(p)}

    def has(self, task: Task) -> bool:
        """Return whether there is a row for this joint and content of a file."""
        return (task.file, task.joint, task.sha256, task.sidecar_sha256) in self._answered

    def add(self, row: dict[str, object]) -> None:
        """Add a row and write it."""
        self._new.append(row)
        part = pl.DataFrame(self._new, schema=SCHEMA)
        self._open = self._write(part, self._open)
        if len(self._new) >= ROWS_OF_PART:
            self._end_part()

    def close(self) -> None:
        """Merge all parts into one, in order, and leave the folder to other runs.

        A folder without a result is removed, so that the next run can use it for other work.
        """
        try:
            self._end_part()
            self.frame = _latest([self.frame, *self._added])
            done = bool((self.frame["status"] == DONE).any())
            # One part too: its rows are in the order in which the tasks ended.
            if done and (self._added or len(self._parts) > 1):
                self._put_together()
            if not done:
                self._discard()
        finally:
            self._lock.release()
        if not done:
            with contextlib.suppress(OSError):
                self.folder.rmdir()  # Not if it holds anything else.

    def _put_together(self) -> None:
        if len(self._parts) == 1:
            self._write(self.frame, self._parts[0])
            return
        before = list(self._parts)
        self._write(self.frame)
        for path in before:
            path.unlink(missing_ok=True)
            self._parts.remove(path)

    def _discard(self) -> None:
        for path in (*self._parts, self.folder / MANIFEST):
            path.unlink(missing_ok=True)
        if not any(self._results.iterdir()):
            self._results.rmdir()

    def _end_part(self) -> None:
        """Leave the last part as it is; the next row begins another."""
        if self._new:
            self._added.append(pl.DataFrame(self._new, schema=SCHEMA))
        self._new, self._open = [], None

    def _write(self, rows: pl.DataFrame, path: Path | None = None) -> Path:
        """Write a part, or write it again."""
        if path is None:
            number = 1 + (int(self._parts[-1].stem.rpartition("-")[2]) if self._parts else 0)
            path = self._results / f"part-{number:06d}.parquet"
        stream = io.BytesIO()
        rows.write_parquet(stream, compression="zstd")
        write_bytes_whole(path, stream.getvalue())
        if path not in self._parts:
            self._parts.append(path)
        return path

    def _state(self, path: str) -> tuple[int | None, int | None, str | None]:
        return *file_state(path), sidecar_hash(path, self._sidecar)


def file_state(path: str) -> tuple[int | None, int | None]:
    """Return size in bytes and time of the last change in ns, which identify an unchanged file."""
    try:
        stat = Path(path).stat()
    except OSError:
        return None, None
    return stat.st_size, stat.st_mtime_ns


def row_of(answer: TaskResult) -> dict[str, object]:
    """Return the row of a finished task."""
    failed = answer.failure is not None
    return {
        **dict.fromkeys(SCHEMA),
        **_of_task(answer.task),
        **({} if answer.identified is None else asdict(answer.identified)),
        "status": FAILED if failed else DONE,
        "reason": answer.failure,
        "seconds": answer.seconds,
    }


def row_of_loss(task: Task, reason: str) -> dict[str, object]:
    """Return the row of a task that was given up."""
    return {**dict.fromkeys(SCHEMA), **_of_task(task), "status": FAILED, "reason": reason}


def row_of_file(file: File, reason: str) -> dict[str, object]:
    """Return the row of a file whose joints are unknown."""
    size, modified = file_state(file.path)
    return {
        **dict.fromkeys(SCHEMA),
        "file": file.path,
        "robot": file.robot,
        "joint": file.joint,
        "day": file.day,
        "status": FAILED,
        "reason": reason,
        "size": size,
        "modified": modified,
        "joints_in_file": 1,
    }


def as_name(cell: object) -> str | None:
    """Return a cell of the data set as the name of a robot or joint."""
    return None if cell is None else str(cell)


def _of_task(task: Task) -> dict[str, object]:
    return {name: value for name, value in asdict(task).items() if name in SCHEMA}


def _latest(parts: Iterable[pl.DataFrame]) -> pl.DataFrame:
    """Return the rows of several parts in order; of two rows of the same joint, the later one.

    Rows of an earlier content of a file are dropped.
    """
    rows = pl.concat([pl.DataFrame(schema=SCHEMA), *parts])
    same = [pl.col(c).eq_missing(pl.col(c).last().over("file")) for c in BYTES]
    return rows.filter(*same).unique(KEY, keep="last", maintain_order=True).sort(KEY)


def _read(path: Path) -> pl.DataFrame:
    try:
        part = pl.read_parquet(path)
        if dict(part.schema) != SCHEMA:
            raise StribeckError(
                f"{path} has other columns: remove it, or give another {option('output')}"
            )
    except (pl.exceptions.PolarsError, OSError):
        raise StribeckError(
            f"{path} is damaged: remove it, and its joints will be identified again"
        ) from None
    return part


def _manifest(work: Work) -> dict[str, object]:
    said = asdict(work)
    said["reading"] = {k: v for k, v in work.reading.given().items() if v != ""}
    # Tuples become lists in JSON; the manifest is compared with one that was read.
    return dict(json.loads(json.dumps({"kind": "fleet", **said}, default=str)))
