"""Text files as Parquet files of some hundred thousand rows, so that they can be read in parts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, enter
from stribeck.recording.formats.text import NULLS, Layout, layout_of

__all__ = ["TEXT", "text_parts"]

#: Ends of the names of text files.
TEXT = (".csv", ".tsv")
#: Bytes of text that become one part.
PIECE = 1 << 26
#: Bytes in which header and layout are found.
HEAD = 1 << 20


def text_parts(path: str, asked: Asked, folder: Path) -> list[str]:
    """Write the rows of a text file as Parquet files into a folder; their paths, in order.

    The types of the columns are those of the first part; where a later one has other numbers, all
    parts are made again with floating-point numbers.

    Raises
    ------
    RecordingError
        The text cannot be read in parts.
    """
    file = enter(Path(path), asked)
    with open(path, "rb") as stream:
        head = stream.read(HEAD)
    if file.compressed or head[:2] in (b"\xff\xfe", b"\xfe\xff") or b"\0" in head[:4096]:
        raise RecordingError(f"{path}: only plain text is read in passes: write it as Parquet")
    begin = len(b"\xef\xbb\xbf") if head.startswith(b"\xef\xbb\xbf") else 0
    layout = layout_of(file, head[begin:], asked, None)
    if layout.separator == " ":
        raise RecordingError(
            f"{path}: columns that blanks separate are not read in passes: write commas, or Parquet"
        )
    for whole_numbers in (True, False):
        made = _written(path, layout, begin + layout.start, folder, whole_numbers=whole_numbers)
        if made is not None:
            return made
    raise RecordingError(
        f"{path}: later rows have other columns, or text where the first ones have numbers: "
        "correct them, or read the file into memory, which names the line"
    )


def _written(
    path: str, layout: Layout, start: int, folder: Path, *, whole_numbers: bool
) -> list[str] | None:
    """The parts; None where a part does not have the columns of the first."""
    made: list[str] = []
    schema: pl.Schema | None = None
    for piece in _pieces(path, start):
        try:
            table = pl.read_csv(
                piece,
                has_header=False,
                new_columns=layout.names,
                separator=layout.separator,
                decimal_comma=layout.decimal_comma,
                null_values=NULLS,
                schema_overrides=schema,
                infer_schema_length=None,
            )
        except (pl.exceptions.PolarsError, pl.exceptions.PanicException):
            return None
        if table.width != len(layout.names):
            return None
        if schema is None:
            if not whole_numbers:
                table = table.cast({pl.Int64: pl.Float64})
            schema = table.schema
        made.append(str(folder / f"{Path(path).stem}-{len(made):06d}.parquet"))
        table.write_parquet(made[-1])
    return made


def _pieces(path: str, start: int) -> Iterator[bytes]:
    """The text from a byte on, in pieces that end with a line."""
    with open(path, "rb") as stream:
        stream.seek(start)
        rest = b""
        while read := stream.read(PIECE):
            whole, mark, after = (rest + read).rpartition(b"\n")
            rest = after
            if mark and whole.strip():
                yield whole
        if rest.strip():
            yield rest
