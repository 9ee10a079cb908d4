"""Tables in memory as the table of a file: polars, pandas, pyarrow, and columns by name."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.tables.readers import Source

__all__ = ["TABLE", "columns_source", "is_table", "table_source"]

#: How sentences name a table that is no file.
TABLE = "the given table"


def is_table(given: object) -> bool:
    """Whether something is a table in memory: a frame, a table of Arrow, or columns by name."""
    return (
        isinstance(given, pl.DataFrame | pl.LazyFrame | Mapping)
        or hasattr(given, "__arrow_c_stream__")
        or _is_pandas(given)
        or (isinstance(given, np.ndarray) and given.dtype.names is not None)
    )


def table_source(given: Any) -> Source:
    """A table in memory as if it had been read from a file.

    Parameters
    ----------
    given
        A polars or pandas frame, a pyarrow table, a mapping from names to arrays [n], or an array
        with named fields.

    Raises
    ------
    RecordingError
        A column is not one-dimensional, their lengths differ, or there is no row.
    """
    if isinstance(given, pl.LazyFrame):
        given = given.collect()
    if isinstance(given, Mapping):
        return columns_source(given)
    if isinstance(given, np.ndarray) and given.dtype.names is not None:
        return columns_source({name: given[name] for name in given.dtype.names})
    if _is_pandas(given):
        return columns_source(_columns_of_pandas(given))
    return _source(given if isinstance(given, pl.DataFrame) else pl.DataFrame(given))


def columns_source(columns: Mapping[str, object]) -> Source:
    """Columns by name as the table of a file; see `table_source`."""
    made: dict[str, pl.Series] = {}
    for name, values in columns.items():
        series = _series(str(name), values)
        first = next(iter(made.values()), series)
        if len(series) != len(first):
            raise RecordingError(
                f"{TABLE}: column '{name}' has {len(series)} values and '{first.name}' "
                f"{len(first)}: give one value of each for every sample; nothing is resampled"
            )
        made[str(name)] = series
    return _source(pl.DataFrame(list(made.values())))


def _series(name: str, values: object) -> pl.Series:
    if isinstance(values, pl.Series):
        return values.alias(name)
    array = np.asarray(values)
    if array.ndim != 1:
        shape = " x ".join(map(str, array.shape)) or "a single value"
        raise RecordingError(
            f"{TABLE}: column '{name}' is {shape}: give a one-dimensional array with one value for "
            "every sample"
        )
    try:
        return pl.Series(name, array.tolist() if array.dtype == object else array)
    except (TypeError, ValueError, pl.exceptions.PolarsError):
        raise RecordingError(
            f"{TABLE}: column '{name}' holds values of several kinds ({array.dtype}): give numbers "
            "or texts"
        ) from None


def _source(table: pl.DataFrame) -> Source:
    if table.width == 0 or table.height == 0:
        raise RecordingError(f"{TABLE}: there are no rows of data in it")
    return Source(TABLE, _hash(table), table, 0)


def _hash(table: pl.DataFrame) -> str:
    """SHA-256 of names, types and values."""
    made = hashlib.sha256()
    for series in table:
        made.update(f"{series.name}\0{series.dtype}\0".encode())
        if series.dtype.is_numeric():
            made.update(np.ascontiguousarray(series.to_numpy()).tobytes())
        else:
            made.update("\0".join(map(str, series.to_list())).encode())
    return made.hexdigest()


def _is_pandas(given: object) -> bool:
    kind = type(given)
    return kind.__module__.partition(".")[0] == "pandas" and kind.__name__ == "DataFrame"


def _columns_of_pandas(frame: Any) -> dict[str, object]:
    """The columns of a pandas frame, and its index where that has a name."""
    columns: dict[str, object] = {}
    if frame.index.name is not None and frame.index.name not in frame.columns:
        columns[str(frame.index.name)] = frame.index.to_numpy()
    for name in frame.columns:
        series = frame[name]
        if getattr(series, "ndim", 1) != 1:
            raise RecordingError(f"{TABLE}: there are two columns '{name}': rename one of them")
        columns[str(name)] = series.to_numpy()
    return columns
