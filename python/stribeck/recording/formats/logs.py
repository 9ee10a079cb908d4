"""Text files by what wrote them."""

from __future__ import annotations

import numpy as np
import polars as pl

from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.part import Part, Read, chosen
from stribeck.recording.formats.scope import is_scope, read_scope
from stribeck.recording.formats.text import decoded, layout_of, read_layout

__all__ = ["read_log"]

#: The clock of tables that PlotJuggler makes of several topics.
_MERGED = "__time"


def read_log(file: Entered, asked: Asked) -> Read:
    """The table of a text file: an export of TwinCAT Scope, or lines of cells.

    Raises
    ------
    RecordingError
        It is no text, has no header and no names were given, or a line does not fit the others.
    """
    data = decoded(file)
    if is_scope([line.decode(errors="replace") for line in data[:4096].splitlines()]):
        return read_scope(file, data, asked)
    separator = "\t" if file.suffix == ".tsv" else None
    read = read_layout(file, data, layout_of(file, data, asked, separator))
    if _MERGED in read.table.columns:
        return _by_time(file, read, asked)
    return read


def _by_time(file: Entered, read: Read, asked: Asked) -> Read:
    """The columns of a table in which each row has the values of one topic alone."""
    table = read.table.rename({_MERGED: "time"}) if "time" not in read.table.columns else read.table
    clock = "time" if "time" not in read.table.columns else _MERGED
    columns = [c for c in table.columns if c != clock]
    # Columns with values in the same rows are of one topic.
    topics: dict[bytes, list[str]] = {}
    for column in columns:
        topics.setdefault(table[column].is_not_null().to_numpy().tobytes(), []).append(column)
    parts = []
    for filled, own in topics.items():
        rows = pl.Series(np.frombuffer(filled, dtype=np.bool_))
        part = table.select(clock, *own)
        parts.append(Part(own[0], part if rows.all() else part.filter(rows), clock))
    got = chosen(file, [p for p in parts if p.table.height], asked)
    whole = got.table.height == table.height
    return Read(got.table, (*read.notes, *got.notes), read.first_line if whole else 0)
