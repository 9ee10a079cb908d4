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
from stribeck.recording.formats.door import MOST_COLUMNS, Asked, Entered
from stribeck.recording.formats.part import Read

__all__ = ["read_arrow", "read_parquet"]

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
            return _spread(file, frame.collect())
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
            return _spread(file, frame.collect())
    except _DAMAGED as error:
        if isinstance(error, RecordingError):
            raise
        raise file.damaged("Arrow", error, "write or copy it again") from None


def _spread(file: Entered, table: pl.DataFrame) -> Read:
    """The table with a column for each place of a list, and for each field of a struct."""
    made: list[pl.Expr] = []
    left: list[str] = []
    for name, dtype in table.schema.items():
        if _single(dtype):
            made.append(pl.col(name))
            continue
        for expression, read in _leaves(table, name, pl.col(name), dtype):
            if read:
                made.append(expression)
            else:
                left.append(expression.meta.output_name())
        file.check_table(table.height, len(made))
    table = table.select(made) if left or len(made) != table.width else table
    file.check_columns(table.columns)
    notes: tuple[str, ...] = ()
    if left:
        more = f" and {len(left) - 6} more" if len(left) > 6 else ""
        notes = (f"not read, since they hold no single values: {', '.join(left[:6])}{more}",)
    return Read(table, notes)


def _leaves(
    table: pl.DataFrame, name: str, at: pl.Expr, dtype: _Type
) -> Iterator[tuple[pl.Expr, bool]]:
    """The expressions of the single values of a column, and whether they can be read."""
    if isinstance(dtype, pl.Struct):
        for field in dtype.fields:
            inner = at.struct.field(field.name)
            yield from _leaves(table, f"{name}.{field.name}", inner, field.dtype)
    elif isinstance(dtype, pl.Array) and _single(dtype.inner):
        for i in range(min(dtype.size, MOST_COLUMNS + 1)):
            yield at.arr.get(i).alias(f"{name}[{i}]"), True
    elif isinstance(dtype, pl.List) and _single(dtype.inner):
        lengths = table.select(at.list.len().alias("n"))["n"].drop_nulls().unique().to_list()
        # Lists of several lengths are no columns; an empty one is a missing value.
        if len({*lengths} - {0}) > 1:
            yield at.alias(name), False
            return
        for i in range(min(max(lengths, default=0), MOST_COLUMNS + 1)):
            yield at.list.get(i, null_on_oob=True).alias(f"{name}[{i}]"), True
    else:
        yield at.alias(name), _single(dtype)


def _single(dtype: object) -> bool:
    """Whether a type is that of a single number, text or date."""
    return not (
        isinstance(dtype, pl.List | pl.Array | pl.Struct) or dtype in (pl.Binary, pl.Object)
    )


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
