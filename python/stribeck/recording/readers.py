"""File formats: any of them to one polars table, untouched."""

from __future__ import annotations

import csv
import hashlib
import io
import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import scipy

from stribeck.base.errors import RecordingError

__all__ = ["Source", "read_table"]

_NULLS = ["", "NA", "N/A", "n/a", "null", "NULL", "None"]
_TEXT = {".csv", ".tsv", ".txt", ".dat"}
_KNOWN = ".csv, .tsv, .txt, .parquet, .arrow, .feather, .npz, .mat"


class Source:
    """A table as the file has it.

    Attributes
    ----------
    table
        Every column of the file, one row a sample.
    sha256
        Hash of the file's bytes, in hexadecimal.
    first_line
        Line number of the first row in a text file, 0 in a binary one.
    """

    def __init__(self, path: str, sha256: str, table: pl.DataFrame, first_line: int) -> None:
        self.path = path
        self.sha256 = sha256
        self.table = table
        self.first_line = first_line

    def place(self, row: int) -> str:
        """Name a row (counted from 0) the way a person finds it in the file."""
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
            raise RecordingError(
                f"{name}: is a directory, give one recording file (fit, diagnose and improve take "
                "folders of Parquet files too)"
            )
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
    if suffix in _TEXT:
        table, first_line = _read_text(name, data_read, suffix)
    elif suffix in (".parquet", ".pq"):
        table = _polars(name, "Parquet", lambda: pl.read_parquet(io.BytesIO(data_read)))
    elif suffix in (".arrow", ".feather", ".ipc", ".arrows"):
        table = _polars(name, "Arrow", lambda: _read_arrow(data_read))
    elif suffix == ".npz":
        table = _read_npz(name, data_read)
    elif suffix == ".mat":
        table = _read_mat(name, data_read)
    else:
        kind = f"'{suffix}' files are" if suffix else "a file without an extension is"
        raise RecordingError(f"{name}: {kind} not known, the formats read are {_KNOWN}")
    if table.width == 0 or table.height == 0:
        raise RecordingError(f"{name}: there are no rows of data in the file")
    return Source(name, hashlib.sha256(data).hexdigest(), table, first_line)


def _beside(path: Path) -> str:
    from stribeck.base.errors import nearest

    try:
        return nearest(path.name, [p.name for p in path.parent.iterdir() if p.is_file()])
    except OSError:
        return ""


def _polars(name: str, kind: str, read: Any) -> pl.DataFrame:
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


# ---------------------------------------------------------------------------------------- text


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip().strip('"').replace(",", "."))
    except ValueError:
        return False
    return True


def _read_text(name: str, data: bytes, suffix: str) -> tuple[pl.DataFrame, int]:
    if b"\0" in data[:4096] and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise RecordingError(f"{name}: is a binary file, not text: give it its right extension")
    encoding = "utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    text = data.decode(encoding, errors="replace")
    lines = text.splitlines()
    # Comments may stand above the header; the last one may be the header itself.
    start = 0
    while start < len(lines) and (not lines[start].strip() or lines[start].lstrip()[0] in "#%"):
        start += 1
    if start == len(lines):
        raise RecordingError(f"{name}: there are no rows of data in the file")
    separator = "\t" if suffix == ".tsv" else _separator(lines[start : start + 5])
    header = _split(lines[start], separator)
    if all(_is_number(cell) for cell in header if cell.strip()):
        above = lines[start - 1].lstrip("#% \t") if start else ""
        if above and len(_split(above, separator)) == len(header):
            header = _split(above, separator)
        else:
            raise RecordingError(
                f"{name}: line {start + 1} holds numbers where the column names should be: "
                "add a first line such as time,position,velocity,torque"
            )
    else:
        start += 1
    header = [
        cell.strip().strip('"').strip("'").strip() or f"column_{i + 1}"
        for i, cell in enumerate(header)
    ]
    twice = [column for column, count in Counter(header).items() if count > 1]
    if twice:
        raise RecordingError(f"{name}: two columns are both called '{twice[0]}', rename one")
    body = lines[start:]
    if separator == " ":
        body = [",".join(line.split()) for line in body]
        separator = ","
    blank = [i for i, line in enumerate(body) if not line.strip()]
    # A last blank line is usual; blank lines inside would shift the row numbers told to the user.
    body = [line for line in body if line.strip()] if blank else body
    if not body:
        raise RecordingError(f"{name}: there are no rows of data in the file")
    decimal_comma = separator != "," and any("," in cell for cell in _split(body[0], separator))
    try:
        table = pl.read_csv(
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
        table = None
    if table is None or table.width != len(header):
        for i, row in enumerate(csv.reader(body, delimiter=separator)):
            if len(row) != len(header):
                raise RecordingError(
                    f"{name}: row {i + 1} (line {start + i + 1}) has {len(row)} cells where the "
                    "header "
                    f"has {len(header)} columns: mend that line"
                )
        raise RecordingError(f"{name}: is not a table of comma-separated values, export it again")
    first_line = start + 1 if not blank or blank[0] >= len(body) else 0
    return table, first_line


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


# -------------------------------------------------------------------------------------- arrays


def _from_arrays(name: str, arrays: Mapping[str, Any]) -> pl.DataFrame:
    """Make a table of the arrays that share the most common length."""
    columns: dict[str, np.ndarray[Any, Any]] = {}
    for key, value in arrays.items():
        _spread(key, np.asarray(value), columns)
    lengths = Counter(len(column) for column in columns.values() if len(column) > 1)
    if not lengths:
        lengths = Counter(len(column) for column in columns.values())
    if not lengths:
        raise RecordingError(f"{name}: holds no arrays of numbers")
    length = max(lengths, key=lambda n: (lengths[n], n))
    return pl.DataFrame({key: column for key, column in columns.items() if len(column) == length})


def _spread(
    key: str, value: np.ndarray[Any, Any], columns: dict[str, np.ndarray[Any, Any]]
) -> None:
    if value.dtype.names:
        # A struct: its fields are the columns; a struct array of one is how MATLAB stores it.
        for field in value.dtype.names:
            inner = value[field]
            if inner.dtype == object and inner.size == 1:
                inner = np.asarray(inner.reshape(-1)[0])
            _spread(field, inner, columns)
        return
    if value.dtype.kind == "O":
        try:
            flat = [str(np.squeeze(item)) for item in value.reshape(-1)]
        except ValueError:
            return
        value = np.asarray(flat)
    if value.dtype.kind not in "biufUSM" or value.ndim == 0:
        return
    value = value.astype(value.dtype.newbyteorder("="))
    squeezed = np.squeeze(value)
    if squeezed.ndim == 0:
        squeezed = squeezed.reshape(1)
    if squeezed.ndim == 1:
        columns[key] = np.ascontiguousarray(squeezed)
    elif squeezed.ndim == 2:
        # One column a joint; the long side is time.
        table = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
        for i in range(table.shape[1]):
            columns[f"{key}_{i + 1}"] = np.ascontiguousarray(table[:, i])


def _read_npz(name: str, data: bytes) -> pl.DataFrame:
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {key: archive[key] for key in archive.files}
    except Exception as error:  # the zip and pickle layers raise many kinds
        reason = str(error).splitlines()[0][:100] if str(error) else type(error).__name__
        raise RecordingError(
            f"{name}: is not a whole .npz file ({reason}): write it again"
        ) from None
    return _from_arrays(name, arrays)


def _read_mat(name: str, data: bytes) -> pl.DataFrame:
    if (
        re.match(rb"MATLAB 7\.3", data[:32])
        or data[512:520] == b"\x89HDF\r\n\x1a\n"
        or data[:4] == b"\x89HDF"
    ):
        return _read_mat73(name, data)

    try:
        loaded = scipy.io.loadmat(io.BytesIO(data))
    except Exception as error:  # scipy raises many kinds on damaged files
        reason = str(error).splitlines()[0][:100] if str(error) else type(error).__name__
        raise RecordingError(
            f"{name}: is not a whole .mat file ({reason}): save it again"
        ) from None
    return _from_arrays(
        name, {key: value for key, value in loaded.items() if not key.startswith("__")}
    )


def _read_mat73(name: str, data: bytes) -> pl.DataFrame:
    try:
        import h5py
    except ImportError:
        raise RecordingError(
            f"{name}: is a MATLAB 7.3 file, which needs h5py: install it (pip install h5py), "
            "or save with -v7 in MATLAB"
        ) from None
    arrays: dict[str, Any] = {}
    try:
        with h5py.File(io.BytesIO(data), "r") as file:

            def take(key: str, item: Any) -> None:
                if (
                    isinstance(item, h5py.Dataset)
                    and not key.startswith("#")
                    and item.dtype.kind in "biuf"
                ):
                    arrays[key.rsplit("/", 1)[-1]] = item[()]

            file.visititems(take)
    except OSError:
        raise RecordingError(f"{name}: is not a whole .mat file: save it again") from None
    return _from_arrays(name, arrays)
