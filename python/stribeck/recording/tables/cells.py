"""Cells of a table as names or as numbers."""

from __future__ import annotations

import re

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.tables.readers import Source

__all__ = ["column_numbers", "labels", "numbered"]


def labels(table: pl.DataFrame, column: str) -> pl.Series:
    """A column as names of joints or runs, [rows]; whole numbers have no decimal point."""
    series = table[column]
    if series.dtype.is_float():
        values = series.unique()
        return series.replace_strict(values, list(map(_label, values)), return_dtype=pl.String)
    return series.cast(pl.String).fill_null("")


def _label(value: float | None) -> str:
    if value is None:
        return ""
    return str(int(value)) if value.is_integer() else str(value)


def numbered(names: pl.Series) -> tuple[list[str], Ints]:
    """The different names in order of appearance, and the number of the name in each row."""
    different = names.unique(maintain_order=True)
    number = np.arange(len(different), dtype=np.int64)
    return different.to_list(), names.replace_strict(different, number).to_numpy()


def _dates(series: pl.Series) -> pl.Series:
    """Texts such as ``2026-11-23 12:00:00.125`` as dates and times; other texts as they are."""
    bare = series.str.strip_chars()
    first = bare.drop_nulls().head(1)
    if first.is_empty() or not re.match(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}[T ]", first[0]):
        return series
    try:
        dates = bare.str.to_datetime(strict=False, time_unit="ns")
    except pl.exceptions.PolarsError:
        return series
    return series if dates.null_count() > bare.null_count() else dates


def column_numbers(source: Source, table: pl.DataFrame, row: Ints, column: str) -> Floats:
    """A column as numbers, [rows]; NaN where a cell is empty.

    Raises
    ------
    RecordingError
        A cell holds text; the sentence names file, row and column.
    """
    series = table[column]
    if series.dtype == pl.String:
        series = _dates(series)
    dtype = series.dtype
    if dtype == pl.String:
        bare = series.str.strip_chars()
        numbers = bare.cast(pl.Float64, strict=False)
        bad = (numbers.is_null() & bare.is_not_null() & (bare != "")).fill_null(False)
        if bad.any():
            first = int(bad.arg_true()[0])
            raise RecordingError(
                f"{source.path}: {source.place(int(row[first]))}, column '{column}': "
                f"'{str(series[first])[:40]}' is not a number: correct or remove that row"
            )
        series = numbers
    elif dtype.is_temporal():
        if dtype == pl.Date or dtype == pl.Time:
            raise RecordingError(
                f"{source.path}: column '{column}' holds {dtype} values, numbers are needed: "
                "give seconds"
            )
        if dtype == pl.Duration:
            series = series.dt.total_nanoseconds().cast(pl.Float64) * 1e-9
        else:
            # Seconds since the first row: a date in seconds would lose microseconds in rounding.
            series = (series - series.drop_nulls()[0]).dt.total_nanoseconds().cast(
                pl.Float64
            ) * 1e-9
    elif not (dtype.is_numeric() or dtype == pl.Boolean):
        raise RecordingError(
            f"{source.path}: column '{column}' holds {dtype} values, numbers are needed"
        )
    values = series.cast(pl.Float64).fill_null(float("nan")).to_numpy()
    return np.array(values, dtype=np.float64)
