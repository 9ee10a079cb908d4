"""Named arrays of several lengths as parts: arrays of one length are columns of one table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.recording.formats.door import MOST_COLUMNS, Asked, Entered
from stribeck.recording.formats.part import Part, Read, chosen

__all__ = ["Array", "read_arrays"]

#: An array of any type.
Array = NDArray[Any]
#: How many of the arrays that cannot be columns are named.
_SHOWN = 6


def read_arrays(
    file: Entered, arrays: Mapping[str, Array], asked: Asked, unread: list[str]
) -> Read:
    """A table of the arrays of one length, and notes on the others.

    Parameters
    ----------
    arrays
        By name; an array of records is as many arrays as it has fields.
    unread
        What of the file is left out already.
    """
    columns: dict[str, Array] = {}
    for key, value in arrays.items():
        _spread(key, np.asarray(value), columns, unread)
    file.check_columns(list(columns))
    by_length: dict[int, dict[str, Array]] = {}
    for key, column in columns.items():
        by_length.setdefault(len(column), {})[key] = column
    parts = [
        Part(f"the arrays of {length} values, {next(iter(own))} first", pl.DataFrame(own))
        for length, own in by_length.items()
    ]
    read = chosen(file, parts, asked)
    notes = read.notes
    if unread:
        more = f" and {len(unread) - _SHOWN} more" if len(unread) > _SHOWN else ""
        notes = (*notes, f"not read, no columns of numbers: {', '.join(unread[:_SHOWN])}{more}")
    return Read(read.table, notes)


def _spread(key: str, value: Array, columns: dict[str, Array], unread: list[str]) -> None:
    """Enter the columns of one array, or of the fields of a struct."""
    if value.dtype.names:
        for field, inner in _fields(value):
            found: dict[str, Array] = {}
            own: list[str] = []
            _spread(field, inner, found, own)
            unread += [f"{key}.{name}" for name in own]
            for column, values in found.items():
                there = columns.get(column)
                same = there is None or np.array_equal(there, values)
                # Fields of two structs may have one name.
                columns[column if same else f"{key}.{column}"] = values
        return
    if value.dtype.kind == "O":
        flat = _texts(value)
        if flat is None:
            unread.append(key)
            return
        value = flat
    if value.dtype.kind not in "biufUSM":
        unread.append(key)
        return
    if value.ndim == 0 or value.size == 0:
        return
    value = value.astype(value.dtype.newbyteorder("="), copy=False)
    squeezed = np.squeeze(value)
    if squeezed.ndim == 0:
        squeezed = squeezed.reshape(1)
    if squeezed.ndim == 1:
        columns[key] = np.ascontiguousarray(squeezed)
    elif squeezed.ndim == 2 and min(squeezed.shape) <= MOST_COLUMNS:
        # One column per joint; the long side is time.
        table = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
        for i in range(table.shape[1]):
            columns[f"{key}_{i + 1}"] = np.ascontiguousarray(table[:, i])
    else:
        unread.append(f"{key} ({' x '.join(map(str, value.shape))})")


def _fields(value: Array) -> Iterator[tuple[str, Array]]:
    """The fields of a struct; of an array of structs, one of each, numbered from 1."""
    for field in value.dtype.names or ():
        inner = value[field]
        if inner.dtype != object:
            yield field, inner
        elif inner.size == 1:
            yield field, np.asarray(inner.reshape(-1)[0])
        elif all(np.size(item) == 1 for item in inner.reshape(-1)):
            yield field, inner
        else:
            for i, item in enumerate(inner.reshape(-1)):
                yield f"{field}({i + 1})", np.asarray(item)


def _texts(value: Array) -> Array | None:
    """Cells of one text or number each; None where a cell holds more."""
    items = [np.squeeze(np.asarray(item)) for item in value.reshape(-1)]
    if any(item.ndim or item.dtype.kind not in "biufUS" for item in items):
        return None
    if items and all(item.dtype.kind in "biuf" for item in items):
        return np.array([float(item) for item in items])
    return np.array([str(item) for item in items])
