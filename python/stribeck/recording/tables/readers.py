"""Files of any known format as a polars table, unchanged."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.door import Asked, Entered, enter
from stribeck.recording.formats.part import Read

__all__ = ["SUFFIXES", "Source", "read_table"]

#: Endings of names -> module and function that read them. A module is imported when it is needed.
_READERS: dict[str, tuple[str, str]] = {
    **dict.fromkeys((".csv", ".tsv", ".txt", ".dat"), ("logs", "read_log")),
    **dict.fromkeys((".parquet", ".pq"), ("columnar", "read_parquet")),
    **dict.fromkeys((".arrow", ".feather", ".ipc", ".arrows"), ("columnar", "read_arrow")),
    ".npz": ("npz", "read_npz"),
    ".mat": ("mat", "read_mat"),
    **dict.fromkeys((".h5", ".hdf5", ".he5"), ("hdf5", "read_hdf5")),
    ".tdms": ("tdms", "read_tdms"),
    ".mcap": ("mcap", "read_mcap"),
    **dict.fromkeys((".bag", ".db3"), ("rosbag", "read_bag")),
}
#: Ends of the names of files that are read, without .gz.
SUFFIXES = frozenset(_READERS)
_KNOWN = ".csv, .tsv, .txt, .parquet, .arrow, .feather, .npz, .mat, .h5, .tdms, .mcap, .bag, .db3"


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
    joints
        Name of a joint -> its index in the names of the columns, where the file says it.
    """

    def __init__(
        self,
        path: str,
        sha256: str,
        table: pl.DataFrame,
        first_line: int,
        notes: tuple[str, ...] = (),
        joints: dict[str, str] | None = None,
    ) -> None:
        self.path = path
        self.notes = notes
        self.sha256 = sha256
        self.table = table
        self.first_line = first_line
        self.joints = joints or {}

    def place(self, row: int) -> str:
        """Name a row (counted from 0) as in the file: by its number from 1, and its line."""
        if self.first_line:
            return f"row {row + 1} (line {row + self.first_line})"
        return f"row {row + 1}"


def read_table(path: str | Path, asked: Asked | None = None) -> Source:
    """Read a file of any known format.

    Parameters
    ----------
    asked
        What decides which of several tables of the file is read.

    Raises
    ------
    RecordingError
        When there is no such file, its format is not known, it is damaged or too large for memory.
    """
    asked = asked or Asked()
    file = enter(Path(path), asked)
    reader = _READERS.get(file.suffix)
    if reader is None:
        raise _unknown(file)
    module, function = reader
    read: Callable[[Entered, Asked], Read] = getattr(
        import_module(f"stribeck.recording.formats.{module}"), function
    )
    try:
        with file.hashing() as sha256:
            got = read(file, asked)
            hashed = sha256()
    except MemoryError:
        raise file.above("the table") from None
    if got.table.width == 0 or got.table.height == 0:
        raise RecordingError(f"{file.name}: there are no rows of data in the file")
    if asked.columns and module != "logs":
        raise RecordingError(f"{file.name}: its columns have names: omit the names of columns")
    return Source(file.name, hashed, got.table, got.first_line, got.notes, got.joints)


def _unknown(file: Entered) -> RecordingError:
    suffix = file.suffix[:20]
    kind = f"'{suffix}' files are" if suffix else "a file without an extension is"
    return RecordingError(f"{file.name}: {kind} not known, the formats read are {_KNOWN}")
