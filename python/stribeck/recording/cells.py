"""Cells of a table as names or as numbers."""

from __future__ import annotations

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.readers import Source

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


def column_numbers(source: Source, table: pl.DataFrame, row: Ints, column: str) -> Floats:
    """A column as numbers, [rows]; NaN where a cell is empty.

    Raises
    ------
    RecordingError
        A cell holds text; the sentence names file, row and column.
    """
    series = table[column]
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
