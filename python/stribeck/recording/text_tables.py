"""Text files (CSV and its relatives) as a table."""

from __future__ import annotations

import csv
import io
from collections import Counter

import polars as pl

from stribeck.base.errors import RecordingError

__all__ = ["read_text"]

_NULLS = ["", "NA", "N/A", "n/a", "null", "NULL", "None"]


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip().strip('"').replace(",", "."))
    except ValueError:
        return False
    return True


def read_text(name: str, data: bytes, suffix: str) -> tuple[pl.DataFrame, int]:
    """The table of a text file, and the line of its first row; 0 where lines do not count rows."""
    lines = _lines(name, data)
    start = _first_line(lines)
    if start == len(lines):
        raise RecordingError(f"{name}: there are no rows of data in the file")
    separator = "\t" if suffix == ".tsv" else _separator(lines[start : start + 5])
    header, start = _header(name, lines, start, separator)
    body = lines[start:]
    if separator == " ":
        body = [",".join(line.split()) for line in body]
        separator = ","
    blank = [i for i, line in enumerate(body) if not line.strip()]
    # A last blank line is usual; blank lines inside would shift the row numbers in messages.
    body = [line for line in body if line.strip()] if blank else body
    if not body:
        raise RecordingError(f"{name}: there are no rows of data in the file")
    table = _parsed(body, header, separator)
    if table is None or table.width != len(header):
        for i, row in enumerate(csv.reader(body, delimiter=separator)):
            if len(row) != len(header):
                raise RecordingError(
                    f"{name}: row {i + 1} (line {start + i + 1}) has {len(row)} cells where the "
                    f"header has {len(header)} columns: correct that line"
                )
        raise RecordingError(f"{name}: is not a table of comma-separated values, export it again")
    return table, start + 1 if not blank or blank[0] >= len(body) else 0


def _lines(name: str, data: bytes) -> list[str]:
    utf16 = data[:2] in (b"\xff\xfe", b"\xfe\xff")
    if b"\0" in data[:4096] and not utf16:
        raise RecordingError(
            f"{name}: is a binary file, not text: give it the extension of its format"
        )
    return data.decode("utf-16" if utf16 else "utf-8-sig", errors="replace").splitlines()


def _first_line(lines: list[str]) -> int:
    """The first line that is neither blank nor a comment."""
    start = 0
    while start < len(lines) and (not lines[start].strip() or lines[start].lstrip()[0] in "#%"):
        start += 1
    return start


def _header(name: str, lines: list[str], start: int, separator: str) -> tuple[list[str], int]:
    """The column names, and the line below them; they may be the last comment above the data."""
    header = _split(lines[start], separator)
    if all(_is_number(cell) for cell in header if cell.strip()):
        above = lines[start - 1].lstrip("#% \t") if start else ""
        if not above or len(_split(above, separator)) != len(header):
            raise RecordingError(
                f"{name}: line {start + 1} holds numbers where the column names should be: "
                "add a first line such as time,position,velocity,torque"
            )
        header = _split(above, separator)
    else:
        start += 1
    header = [
        cell.strip().strip('"').strip("'").strip() or f"column_{i + 1}"
        for i, cell in enumerate(header)
    ]
    twice = [column for column, count in Counter(header).items() if count > 1]
    if twice:
        raise RecordingError(f"{name}: two columns are both called '{twice[0]}', rename one")
    return header, start


def _parsed(body: list[str], header: list[str], separator: str) -> pl.DataFrame | None:
    """The table; None where the lines have different numbers of cells."""
    decimal_comma = separator != "," and any("," in cell for cell in _split(body[0], separator))
    try:
        return pl.read_csv(
            io.BytesIO("\n".join(body).encode()),
            has_header=False,
            new_columns=header,
            separator=separator,
            infer_schema_length=None,
            decimal_comma=decimal_comma,
            null_values=_NULLS,
            raise_if_empty=False,
        )
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException):
        return None


def _split(line: str, separator: str) -> list[str]:
    if separator == " ":
        return line.split()
    return next(csv.reader([line], delimiter=separator), [])


def _separator(lines: list[str]) -> str:
    counts = {mark: min(line.count(mark) for line in lines) for mark in (";", "\t", ",")}
    best = max(counts, key=lambda mark: counts[mark])
    # A semicolon in every line decides: commas may then be decimal commas.
    if counts[";"]:
        return ";"
    if counts[best]:
        return best
    return " " if len(lines[0].split()) > 1 else ","
