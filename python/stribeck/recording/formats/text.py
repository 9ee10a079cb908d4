"""Text files (CSV and its relatives) as a table."""

from __future__ import annotations

import csv
import re
from collections import Counter
from dataclasses import dataclass
from typing import Any

import polars as pl

from stribeck.base.errors import RecordingError, option
from stribeck.recording.formats.door import MOST_COLUMNS, Asked, Entered
from stribeck.recording.formats.lines import LONGEST_CELL, LONGEST_LINE, Lines, look
from stribeck.recording.formats.part import Read

__all__ = ["NULLS", "Layout", "decoded", "layout_of", "read_layout"]

#: Cells that hold nothing.
NULLS = ["", "NA", "N/A", "n/a", "null", "NULL", "None"]
#: Rows from which the types of the columns are taken at first.
_TYPED_ROWS = 1000
#: Bytes in which the first lines are looked for, and how many of these decide.
_HEAD, _DECIDING = 1 << 20, 100


@dataclass(frozen=True)
class Layout:
    """How the text of a table is laid out.

    Attributes
    ----------
    names
        Of the columns.
    separator
        Between cells; a blank stands for any number of blanks.
    start, line
        Byte of the first row, and its line number.
    decimal_comma
        Whether numbers are written 1,5.
    """

    names: list[str]
    separator: str
    start: int
    line: int
    decimal_comma: bool


def decoded(file: Entered) -> bytes:
    """The bytes of a text file in UTF-8, with lines that end in newlines.

    Raises
    ------
    RecordingError
        It is a binary file.
    """
    data = file.data
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", errors="replace").encode()
    elif b"\0" in data[:4096]:
        raise RecordingError(
            f"{file.name}: is a binary file, not text: give it the extension of its format"
        )
    data = data.removeprefix(b"\xef\xbb\xbf")
    # The last system that ended lines with a lone carriage return is of 2001.
    if b"\r" in data[:_HEAD] and b"\n" not in data[:_HEAD]:
        data = data.replace(b"\r", b"\n")
    return data


def layout_of(file: Entered, data: bytes, asked: Asked, separator: str | None) -> Layout:
    """Find header, separator and first row.

    Raises
    ------
    RecordingError
        There is no row, or no header and no names were given.
    """
    lines, places = _head(file, data)
    first = next((i for i, line in enumerate(lines) if _is_data(line)), len(lines))
    if first == len(lines):
        raise RecordingError(f"{file.name}: there are no rows of data in the file")
    following = [line for line in lines[first : first + _DECIDING] if line.strip()]
    separator = separator or _separator(following[:5])
    names, start = _names(file, lines, first, separator, asked)
    rows = [line for line in lines[start : start + _DECIDING] if line.strip()]
    if not rows:
        raise RecordingError(f"{file.name}: there are no rows of data in the file")
    comma = separator != "," and any("," in c for row in rows for c in _split(row, separator))
    return Layout(names, separator, places[start], start + 1, comma)


def _head(file: Entered, data: bytes) -> tuple[list[str], list[int]]:
    """The first lines, and the byte where each begins."""
    raw = data[:_HEAD].split(b"\n")
    if len(data) > _HEAD and len(raw) > 1:
        raw.pop()
    if len(raw[0]) > LONGEST_LINE:
        raise RecordingError(
            f"{file.name}: line 1 has more than {LONGEST_LINE} characters, which no recording has: "
            "is it of another kind, or without line ends?"
        )
    places, at = [], 0
    for line in raw:
        places.append(at)
        at += len(line) + 1
    places.append(min(at, len(data)))
    return [line.decode(errors="replace").rstrip("\r") for line in raw], places


def _is_data(line: str) -> bool:
    """Whether a line is neither blank nor a comment."""
    return bool(line.strip()) and line.lstrip()[0] not in "#%"


def _names(
    file: Entered, lines: list[str], first: int, separator: str, asked: Asked
) -> tuple[list[str], int]:
    """The column names, and the line below them; they may be the last comment above the data."""
    header = _split(lines[first], separator)
    start = first + 1
    if all(_is_number(cell) for cell in header if cell.strip()):
        header, start = _without_header(file, lines, first, len(header), separator, asked), first
    elif asked.columns:
        raise RecordingError(
            f"{file.name}: line {first + 1} has the names of the columns ({_first(header)}): omit "
            f"{option('columns')}, which is for tables without them"
        )
    if len(header) > MOST_COLUMNS:
        file.check_columns(header)
    names = [
        cell.strip().strip('"').strip("'").strip() or f"column_{i + 1}"
        for i, cell in enumerate(header)
    ]
    file.check_columns(names)
    twice = [column for column, count in Counter(names).items() if count > 1]
    if twice:
        raise RecordingError(f"{file.name}: two columns are both called '{twice[0]}', rename one")
    return names, start


def _without_header(
    file: Entered, lines: list[str], first: int, cells: int, separator: str, asked: Asked
) -> list[str]:
    """Names of the columns where the first line has numbers: as given, or of the comment above."""
    if asked.columns:
        if len(asked.columns) != cells:
            raise RecordingError(
                f"{file.name}: {option('columns', ','.join(asked.columns))} gives "
                f"{len(asked.columns)} names, line {first + 1} has {cells} cells: name each column"
            )
        return list(asked.columns)
    above = lines[first - 1].lstrip("#% \t") if first else ""
    if not above or len(_split(above, separator)) != cells:
        example = ",".join(("time", "position", "velocity", "torque")[:cells])
        raise RecordingError(
            f"{file.name}: line {first + 1} holds numbers where the column names should be: "
            f"add a first line such as time,position,velocity,torque, or name the {cells} columns "
            f"with {option('columns', example)}"
        )
    return _split(above, separator)


def read_layout(file: Entered, data: bytes, layout: Layout, *, short: bool = False) -> Read:
    """The table of a text whose layout is known.

    Parameters
    ----------
    short
        Whether lines may end before their last columns, which are then empty.

    Raises
    ------
    RecordingError
        A line does not fit the others.
    """
    separator, start, width = layout.separator, layout.start, len(layout.names)
    # Blank lines at the end are usual.
    if data.endswith((b"\n\n", b"\n\r\n")):
        data = data.rstrip(b"\r\n") + b"\n"
    seen = look(file, data, start, layout.line, separator.encode(), width - 1)
    file.check_table(seen.count, width)
    notes: tuple[str, ...] = ()
    body: bytes | memoryview = memoryview(data)[start:] if start else data
    if seen.uneven is not None and not seen.quotes and not short:
        body, separator, notes = _evened(file, data, layout, seen)
    elif seen.blank:
        body = _without_blank(bytes(body))
    table = _parsed(bytes(body), layout, separator)
    if table is None or table.width != width:
        raise _uneven(file, data, layout)
    return Read(table, notes=notes, first_line=0 if seen.blank else layout.line)


def _evened(
    file: Entered, data: bytes, layout: Layout, seen: Lines
) -> tuple[memoryview, str, tuple[str, ...]]:
    """The rows of a table whose lines differ, by blanks alone, or because the last is cut off."""
    body = data[layout.start :]
    separator = layout.separator
    if separator == " ":
        body = re.sub(rb"[ \t]+", b",", re.sub(rb"(?m)^[ \t]+|[ \t]+(?=\r?$)", b"", body))
        separator = ","
    if seen.blank or separator != layout.separator:
        body = _without_blank(body)
    again = look(file, body, 0, 1, separator.encode(), len(layout.names) - 1)
    if again.uneven is None:
        return memoryview(body), separator, ()
    line, marks = again.uneven
    if line == again.count and again.end < len(body) and marks < len(layout.names) - 1 and line > 1:
        note = f"the last line is cut off after {marks + 1} cells and left out"
        return memoryview(body)[: again.end], separator, (note,)
    raise _uneven(file, data, layout)


def _without_blank(body: bytes) -> bytes:
    """The lines that hold something."""
    return re.sub(rb"\n(?:[ \t\r]*\n)+", b"\n", body).lstrip(b"\r\n")


def _uneven(file: Entered, data: bytes, layout: Layout) -> RecordingError:
    """The error about the first row with another number of cells."""
    rows = 0
    for i, line in enumerate(data[layout.start :].decode(errors="replace").splitlines()):
        if not line.strip():
            continue
        rows += 1
        if max(map(len, line.split(layout.separator)), default=0) > LONGEST_CELL:
            return RecordingError(
                f"{file.name}: a cell of line {layout.line + i} has more than {LONGEST_CELL} "
                "characters: correct that line"
            )
        cells = len(_split(line, layout.separator))
        if cells != len(layout.names):
            return RecordingError(
                f"{file.name}: row {rows} (line {layout.line + i}) has {cells} cells where the "
                f"header has {len(layout.names)} columns: correct that line"
            )
    return RecordingError(f"{file.name}: is not a table of comma-separated values, export it again")


def _parsed(body: bytes, layout: Layout, separator: str) -> pl.DataFrame | None:
    """The table; None where the lines have different numbers of cells."""
    options: dict[str, Any] = {
        "has_header": False,
        "new_columns": layout.names,
        "separator": separator,
        "decimal_comma": layout.decimal_comma,
        "null_values": NULLS,
        "raise_if_empty": False,
    }
    # The types of the first rows are nearly always those of all.
    for rows in (_TYPED_ROWS, None):
        try:
            return _numbers(pl.read_csv(body, infer_schema_length=rows, **options))
        except (pl.exceptions.PolarsError, pl.exceptions.PanicException):
            continue
    return None


def _numbers(table: pl.DataFrame) -> pl.DataFrame:
    """Columns of text that all hold numbers, as numbers: their first cells were empty."""
    made = []
    for column in table.iter_columns():
        if column.dtype == pl.String and column.null_count() < len(column):
            for dtype in (pl.Int64, pl.Float64):
                numbers = column.cast(dtype, strict=False)
                if numbers.null_count() == column.null_count():
                    made.append(numbers)
                    break
    return table.with_columns(made) if made else table


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip().strip('"').replace(",", "."))
    except ValueError:
        return False
    return True


def _first(cells: list[str]) -> str:
    return ", ".join(cell.strip()[:40] for cell in cells[:4]) + (", ..." if len(cells) > 4 else "")


def _split(line: str, separator: str) -> list[str]:
    if separator == " ":
        return line.split()
    if '"' not in line:
        return line.split(separator)
    try:
        return next(csv.reader([line], delimiter=separator), [])
    except csv.Error:
        return line.split(separator)


def _separator(lines: list[str]) -> str:
    counts = {mark: min(line.count(mark) for line in lines) for mark in (";", "\t", ",")}
    best = max(counts, key=lambda mark: counts[mark])
    # A semicolon in every line decides: commas may then be decimal commas.
    if counts[";"]:
        return ";"
    if counts[best]:
        return best
    return " " if len(lines[0].split()) > 1 else ","
