"""Text exports of TwinCAT Scope: a head of several lines, a time column for each sample time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.names import with_unit
from stribeck.recording.formats.part import Part, Read, chosen, merged
from stribeck.recording.formats.text import Layout, read_layout

__all__ = ["is_scope", "read_scope"]

#: Lines in which the head ends; its keys.
_MOST_LINES = 60
_KEYS = frozenset(
    "Name SymbolComment Data-Type SampleTime[ms] VariableSize SymbolBased IndexGroup IndexOffset "
    "SymbolName NetID NetId Port Offset ScaleFactor BitMask Unit".split()
)
#: Time stamps above this are ticks of 100 ns since 1601, others milliseconds.
_TICKS = 1e16


@dataclass(frozen=True)
class _Head:
    """The head of an export.

    Attributes
    ----------
    rows
        Key -> cells of its line.
    first
        Line of the first values, from 0.
    """

    rows: Mapping[str, list[str]]
    separator: str
    first: int


def is_scope(lines: Sequence[str]) -> bool:
    """Whether the first lines are of an export of TwinCAT Scope."""
    start = [line.replace(";", "\t").replace(",", "\t").split("\t")[0] for line in lines[:10]]
    return start[:1] == ["Name"] and any(
        key in start for key in ("File", "Starttime of export", "StartRecord", "SymbolComment")
    )


def read_scope(file: Entered, data: bytes, asked: Asked) -> Read:
    """The channels of an export; those of one sample time are one part.

    Raises
    ------
    RecordingError
        The head is not complete, or a line does not fit it.
    """
    lines = [line.decode(errors="replace").rstrip("\r") for line in data[: 1 << 20].split(b"\n")]
    head = _head(file, lines)
    groups = _groups(head)
    if not groups:
        raise RecordingError(
            f"{file.name}: the export of TwinCAT Scope has no time columns: export it again with "
            "timelines 'All' or 'For each sample time'"
        )
    start = sum(len(line) + 1 for line in data.split(b"\n", head.first)[: head.first])
    end = data.rstrip(b"\r\n\t ,;")
    if end.endswith(b"EOF"):
        data = end[:-3].rstrip(b"\r\n\t ,;") + b"\n"
    names = [f"{i}" for i in range(len(lines[head.first].split(head.separator)))]
    comma = head.separator != "," and "," in "".join(lines[head.first : head.first + 100])
    layout = Layout(names, head.separator, start, head.first + 1, comma)
    read = read_layout(file, data, layout, short=True)
    parts = [_part(read.table, head, time, channels) for time, channels in groups]
    got = chosen(file, merged([part for part in parts if part.table.height]), asked)
    return Read(got.table, (*read.notes, *got.notes, *_scaled(head)), read.first_line)


def _head(file: Entered, lines: list[str]) -> _Head:
    """The lines that describe the channels."""
    rows: dict[str, list[str]] = {}
    separator = next((m for m in ("\t", ";", ",") if m in lines[0]), "\t")
    for i, line in enumerate(lines[:_MOST_LINES]):
        cells = line.split(separator)
        if cells[0] in _KEYS:
            # The first 'Name' is that of the project.
            rows[cells[0]] = cells
        elif rows and cells[0] and _is_number(cells[0]):
            return _Head(rows, separator, i)
    raise RecordingError(
        f"{file.name}: the head of the export of TwinCAT Scope is not followed by values: export "
        "it again"
    )


def _groups(head: _Head) -> list[tuple[int, list[int]]]:
    """Place of each time column, and places of its channels: a key stands above each time."""
    names = head.rows["Name"]
    times = [i for i, cell in enumerate(names) if cell == "Name"]
    ends = [*times[1:], len(names)]
    return [
        (time, [i for i in range(time + 1, end) if names[i].strip()])
        for time, end in zip(times, ends, strict=True)
    ]


def _part(table: pl.DataFrame, head: _Head, time: int, channels: list[int]) -> Part:
    """The channels of one time column, without the empty rows below them."""
    every = [n for n in head.rows["Name"] if n != "Name"]
    units = head.rows.get("Unit", [])
    columns = {"time": table[str(time)].cast(pl.Float64)}
    for i in channels:
        name = head.rows["Name"][i].strip()
        if every.count(head.rows["Name"][i]) > 1:
            symbols = head.rows.get("SymbolName", [])
            name = symbols[i].strip() if i < len(symbols) and symbols[i].strip() else f"{name}_{i}"
        unit = units[i].strip("() ") if i < len(units) else None
        columns[with_unit(name, unit)] = table[str(i)]
    made = pl.DataFrame(columns).drop_nulls("time")
    stamps = made["time"]
    if stamps.len() and float(stamps[0]) > _TICKS:
        ticks = table[str(time)].drop_nulls()
        made = made.with_columns(((ticks - ticks[0]).cast(pl.Float64) * 1e-7).alias("time"))
    else:
        made = made.with_columns(stamps * 1e-3)
    step = head.rows.get("SampleTime[ms]", [])
    own = f" at {step[time + 1]} ms" if time + 1 < len(step) else ""
    return Part(f"the channels{own}", made, "time")


def _scaled(head: _Head) -> tuple[str, ...]:
    """A note on channels with a scale, which an export may have applied or not."""
    cells = head.rows.get("ScaleFactor", [])
    found = [
        head.rows["Name"][i]
        for i, cell in enumerate(cells)
        if _is_number(cell) and float(cell.replace(",", ".")) != 1.0 and i < len(head.rows["Name"])
    ]
    if not found:
        return ()
    return (
        f"{', '.join(found[:6])}: values as exported; the head has a scale factor, which is not "
        "applied",
    )


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip().replace(",", "."))
    except ValueError:
        return False
    return True
