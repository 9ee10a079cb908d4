"""Consecutive Parquet files, read in parts."""

from __future__ import annotations

import glob
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError

__all__ = ["DataSet"]

SUFFIXES = (".parquet", ".pq")
#: Number of bytes hashed at a time.
HASHED = 1 << 22


@dataclass(frozen=True)
class DataSet:
    """The samples of one or several Parquet files, in the order of their names.

    Attributes
    ----------
    path
        The path given: a file, a folder or a pattern.
    files
        Paths of the files, in order.
    first
        Index of the first row of each file, then the number of all rows, array [files + 1].
    schema
        Columns and their types, the same in every file.
    origin
        First value of each column of dates, from which seconds are counted.
    runs
        Run of which each file is a part; empty: runs follow from the times or a column.
    sources
        File that each of `files` was made from, as sentences name it; empty: they are the files.
    """

    path: str
    files: tuple[str, ...]
    first: NDArray[np.int64]
    schema: pl.Schema
    origin: dict[str, object]
    runs: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()

    @classmethod
    def open(cls, path: str | Path) -> DataSet:
        """Find the files and count their samples; only the first sample is read.

        Parameters
        ----------
        path
            A Parquet file, a folder of them, or a pattern such as ``"logs/2024-*.parquet"``.

        Raises
        ------
        RecordingError
            No files, a damaged one, or files with different columns.
        """
        return cls.of_files(str(path), _found(path))

    @classmethod
    def of_files(
        cls,
        path: str,
        files: Sequence[str],
        *,
        runs: Sequence[str] = (),
        sources: Sequence[str] = (),
    ) -> DataSet:
        """The samples of some Parquet files, in this order; `path` is what sentences name."""
        schema = _schema(files[0])
        counts = []
        for file in files:
            own = _schema(file)
            if own != schema:
                differing = sorted({n for n, _ in set(own.items()) ^ set(schema.items())})
                raise RecordingError(
                    f"{file}: its columns differ from those of {files[0]} (in "
                    f"{', '.join(differing) or 'order'}): write all files with the same columns"
                )
            counts.append(int(pl.scan_parquet(file).select(pl.len()).collect().item()))
        if not sum(counts):
            raise RecordingError(f"{path}: the files contain no samples")
        first = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        dates = [name for name, kind in schema.items() if kind == pl.Datetime]
        head = files[int(np.argmax(np.array(counts) > 0))]
        row = pl.scan_parquet(head).select(dates).head(1).collect()
        origin = {name: row[name][0] for name in dates}
        return cls(path, tuple(files), first, schema, origin, tuple(runs), tuple(sources))

    @property
    def rows(self) -> int:
        """Number of rows of all files."""
        return int(self.first[-1])

    def frame(self, start: int, stop: int, columns: list[str] | None = None) -> pl.DataFrame:
        """Rows `start` to `stop` of the data set, with dates as durations since the first date."""
        parts = []
        begin = int(np.searchsorted(self.first, start, side="right")) - 1
        for k in range(begin, len(self.files)):
            own = int(self.first[k])
            if own >= stop:
                break
            a, b = max(start - own, 0), min(stop, int(self.first[k + 1])) - own
            part = pl.scan_parquet(self.files[k], glob=False).slice(a, b - a)
            parts.append(
                _collected(self.files[k], part if columns is None else part.select(columns))
            )
        whole = parts[0] if len(parts) == 1 else pl.concat(parts)
        return whole.with_columns(
            pl.col(name) - pl.lit(date, dtype=self.schema[name])
            for name, date in self.origin.items()
            if name in whole.columns
        )

    def place(self, row: int) -> str:
        """Name a row (counted from 0) by its file and its row there."""
        k = int(np.searchsorted(self.first, row, side="right")) - 1
        named = self.sources or self.files
        # A file may have been made into several parts.
        first = int(self.first[named.index(named[k])])
        return f"row {row - first + 1} of {Path(named[k]).name}"

    @property
    def named(self) -> tuple[str, ...]:
        """The files that were given, in order."""
        return tuple(dict.fromkeys(self.sources or self.files))

    @cached_property
    def hashes(self) -> tuple[str, ...]:
        """Hash of the bytes of each file that was given."""
        return tuple(_hash(file) for file in self.named)

    @cached_property
    def sha256(self) -> str:
        """Hash of the file's bytes; of several files, of their names and hashes, in order."""
        if len(self.hashes) == 1:
            return self.hashes[0]
        pairs = zip(self.hashes, self.named, strict=True)
        lines = (f"{h}  {Path(f).name}\n" for h, f in pairs)
        return hashlib.sha256("".join(lines).encode()).hexdigest()


def _found(path: str | Path) -> list[str]:
    """The files that match a path, sorted by name."""
    given = Path(path)
    if given.is_dir():
        files = [str(file) for file in given.iterdir() if file.suffix.lower() in SUFFIXES]
        what = "there are no Parquet files in this folder"
    elif given.exists() or not glob.has_magic(str(path)):
        if not given.exists():
            raise RecordingError(f"{path}: no such file or folder")
        files, what = [str(given)], ""
    else:
        files = [file for file in glob.glob(str(path)) if Path(file).is_file()]
        what = "no file matches this pattern"
    if not files:
        raise RecordingError(f"{path}: {what}")
    for file in files:
        if Path(file).suffix.lower() not in SUFFIXES:
            raise RecordingError(
                f"{file}: only Parquet files can be streamed: write it as Parquet, or read "
                "it into memory, without streaming"
            )
    return sorted(files)


def _schema(file: str) -> pl.Schema:
    try:
        return pl.Schema(pl.read_parquet_schema(file))
    except (pl.exceptions.PolarsError, OSError) as error:
        raise _damaged(file, error) from None


def _collected(file: str, frame: pl.LazyFrame) -> pl.DataFrame:
    try:
        return frame.collect()
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError) as error:
        raise _damaged(file, error) from None


def _damaged(file: str, error: BaseException) -> RecordingError:
    reason = str(error).strip().splitlines()[0][:120] if str(error).strip() else "unknown"
    return RecordingError(
        f"{file}: is not a complete Parquet file ({reason}): write or copy it again"
    )


def _hash(file: str) -> str:
    made = hashlib.sha256()
    with open(file, "rb") as stream:
        while part := stream.read(HASHED):
            made.update(part)
    return made.hexdigest()
