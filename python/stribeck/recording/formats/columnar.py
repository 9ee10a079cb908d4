"""Parquet and Arrow files as a table; the places of a list in each row are columns."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeAlias

import polars as pl
from polars.datatypes import DataTypeClass

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.part import Read

__all__ = ["read_arrow", "read_parquet"]

#: Rows of lists that are looked at together.
_ROWS = 1 << 16
_Type: TypeAlias = pl.DataType | DataTypeClass
#: What polars raises on damaged files; a panic is no subclass of the others.
_DAMAGED = (
    pl.exceptions.PolarsError,
    pl.exceptions.PanicException,
    OSError,
    ValueError,
    MemoryError,
)


def read_parquet(file: Entered, asked: Asked) -> Read:
    """The table of a Parquet file.

    Raises
    ------
    RecordingError
        The file is damaged, or too large for memory.
    """
    source: Path | io.BytesIO = file.path
    if file.compressed:
        source = io.BytesIO(file.data)
    try:
        with quiet():
            schema = pl.Schema(pl.read_parquet_schema(source))
            file.check_columns(list(schema))
            frame = pl.scan_parquet(source, glob=False)
            rows = int(frame.select(pl.len()).collect().item())
            file.check_table(rows, len(schema))
            return _spread(file, frame, schema, rows)
    except _DAMAGED as error:
        if isinstance(error, RecordingError):
            raise
        raise file.damaged("Parquet", error, "write or copy it again") from None


def read_arrow(file: Entered, asked: Asked) -> Read:
    """The table of an Arrow or Feather file, or of an Arrow stream.

    Raises
    ------
    RecordingError
        The file is damaged, or too large for memory.
    """
    data = file.data
    try:
        with quiet():
            if data[:6] == b"ARROW1":
                schema = pl.Schema(pl.read_ipc_schema(io.BytesIO(data)))
                frame = pl.scan_ipc(io.BytesIO(data))
                rows = int(frame.select(pl.len()).collect().item())
            else:
                frame = pl.read_ipc_stream(io.BytesIO(data)).lazy()
                schema = frame.collect_schema()
                rows = int(frame.select(pl.len()).collect().item())
            file.check_columns(list(schema))
            file.check_table(rows, len(schema))
            return _spread(file, frame, schema, rows)
    except _DAMAGED as error:
        if isinstance(error, RecordingError):
            raise
        raise file.damaged("Arrow", error, "write or copy it again") from None


def _spread(file: Entered, frame: pl.LazyFrame, schema: pl.Schema, rows: int) -> Read:
    """The table with a column for each place of a list, and for each field of a struct."""
    made: list[pl.Expr] = []
    left: list[str] = []
    cells = 0
    for name, dtype in schema.items():
        for expression, kind in _leaves(file, frame, name, pl.col(name), dtype, rows):
            if kind is None:
                left.append(expression.meta.output_name())
            else:
                made.append(expression)
                cells += 1
    file.check_table(rows, cells)
    table = frame.select(made).collect()
    file.check_columns(table.columns)
    notes: tuple[str, ...] = ()
    if left:
        more = f" and {len(left) - 6} more" if len(left) > 6 else ""
        notes = (f"not read, since they hold no single values: {', '.join(left[:6])}{more}",)
    return Read(table, notes)


def _leaves(
    file: Entered, frame: pl.LazyFrame, name: str, at: pl.Expr, dtype: _Type, rows: int
) -> Iterator[tuple[pl.Expr, _Type | None]]:
    """The expressions of the single values of a column, with their types; None: not read."""
    if isinstance(dtype, pl.Struct):
        for field in dtype.fields:
            inner = at.struct.field(field.name)
            yield from _leaves(file, frame, f"{name}.{field.name}", inner, field.dtype, rows)
    elif isinstance(dtype, pl.Array) and _single(dtype.inner):
        for i in range(dtype.size):
            yield at.arr.get(i).alias(f"{name}[{i}]"), dtype.inner
    elif isinstance(dtype, pl.List) and _single(dtype.inner):
        length = _length(frame, at, rows)
        if length is None:
            yield at.alias(name), None
            return
        file.check_table(rows, length)
        for i in range(length):
            yield at.list.get(i, null_on_oob=True).alias(f"{name}[{i}]"), dtype.inner
    elif _single(dtype) or dtype == pl.Null:
        yield at.alias(name), dtype
    else:
        yield at.alias(name), None


def _single(dtype: object) -> bool:
    """Whether a type is that of a single number, text or date."""
    return not (
        isinstance(dtype, pl.List | pl.Array | pl.Struct) or dtype in (pl.Binary, pl.Object)
    )


def _length(frame: pl.LazyFrame, at: pl.Expr, rows: int) -> int | None:
    """The number of values that each list has; None where they differ."""
    lengths: set[int] = set()
    for first in range(0, rows, _ROWS):
        part = frame.slice(first, _ROWS).select(at.list.len().alias("n")).collect()["n"]
        lengths.update(part.drop_nulls().unique().to_list())
        if len(lengths - {0}) > 1:
            return None
    return max(lengths, default=0)


@contextmanager
def quiet() -> Iterator[None]:
    """Keep what a panic of polars prints off the terminal; it is raised as an exception as well."""
    try:
        kept = os.dup(2)
    except OSError:
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(nowhere)
        os.close(kept)
