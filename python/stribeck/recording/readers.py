"""Files of any known format as a polars table, unchanged."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable
from pathlib import Path

import polars as pl

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.array_tables import read_mat, read_npz
from stribeck.recording.text_tables import read_text

__all__ = ["SUFFIXES", "Source", "read_table"]

_TEXT = {".csv", ".tsv", ".txt", ".dat"}
#: Ends of the names of files that are read, without .gz.
SUFFIXES = frozenset(
    (*_TEXT, ".parquet", ".pq", ".arrow", ".arrows", ".feather", ".ipc", ".npz", ".mat")
)
_KNOWN = ".csv, .tsv, .txt, .parquet, .arrow, .feather, .npz, .mat"


class Source:
    """The table of a file.

    Attributes
    ----------
    table
        Every column of the file.
    sha256
        Hash of the file's bytes, in hexadecimal.
    first_line
        Line number of the first row in a text file, 0 in a binary one.
    notes
        What of the file is not in the table.
    """

    def __init__(
        self,
        path: str,
        sha256: str,
        table: pl.DataFrame,
        first_line: int,
        notes: tuple[str, ...] = (),
    ) -> None:
        self.path = path
        self.notes = notes
        self.sha256 = sha256
        self.table = table
        self.first_line = first_line

    def place(self, row: int) -> str:
        """Name a row (counted from 0) as in the file: by its number from 1, and its line."""
        if self.first_line:
            return f"row {row + 1} (line {row + self.first_line})"
        return f"row {row + 1}"


def read_table(path: str | Path) -> Source:
    """Read a file of any known format.

    Raises
    ------
    RecordingError
        When there is no such file, its format is not known, or it is damaged.
    """
    path = Path(path)
    name = str(path)
    try:
        if path.is_dir():
            raise RecordingError(f"{name}: is a directory, give one recording file")
        data = path.read_bytes()
    except FileNotFoundError:
        raise RecordingError(f"{name}: no such file{_beside(path)}") from None
    except OSError as error:
        raise RecordingError(f"{name}: cannot be read ({error.strerror or error})") from None
    suffix = path.suffix.lower()
    if suffix in (".mcap", ".db3", ".bag"):
        raise RecordingError(
            f"{name}: MCAP and ROS bags are not read yet: export the joint states to CSV or Parquet"
        )
    if suffix == ".gz":
        import gzip

        try:
            data_read = gzip.decompress(data)
        except (OSError, EOFError):
            raise RecordingError(f"{name}: is not a whole gzip file, write it again") from None
        suffix = Path(path.stem).suffix.lower()
    else:
        data_read = data
    if not data:
        raise RecordingError(f"{name}: the file is empty")
    first_line = 0
    notes: tuple[str, ...] = ()
    if suffix in _TEXT:
        table, first_line = read_text(name, data_read, suffix)
    elif suffix in (".parquet", ".pq"):
        table = _polars(name, "Parquet", lambda: pl.read_parquet(io.BytesIO(data_read)))
    elif suffix in (".arrow", ".feather", ".ipc", ".arrows"):
        table = _polars(name, "Arrow", lambda: _read_arrow(data_read))
    elif suffix == ".npz":
        table, notes = read_npz(name, data_read)
    elif suffix == ".mat":
        table, notes = read_mat(name, data_read)
    else:
        kind = f"'{suffix}' files are" if suffix else "a file without an extension is"
        raise RecordingError(f"{name}: {kind} not known, the formats read are {_KNOWN}")
    if table.width == 0 or table.height == 0:
        raise RecordingError(f"{name}: there are no rows of data in the file")
    return Source(name, hashlib.sha256(data).hexdigest(), table, first_line, notes)


def _beside(path: Path) -> str:
    try:
        return nearest(path.name, [p.name for p in path.parent.iterdir() if p.is_file()])
    except OSError:
        return ""


def _polars(name: str, kind: str, read: Callable[[], pl.DataFrame]) -> pl.DataFrame:
    try:
        table: pl.DataFrame = read()
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError, ValueError) as error:
        reason = str(error).strip().splitlines()[0][:120] if str(error).strip() else "unknown"
        raise RecordingError(
            f"{name}: is not a whole {kind} file ({reason}): write or copy it again"
        ) from None
    return table


def _read_arrow(data: bytes) -> pl.DataFrame:
    if data[:6] == b"ARROW1":
        return pl.read_ipc(io.BytesIO(data))
    return pl.read_ipc_stream(io.BytesIO(data))
