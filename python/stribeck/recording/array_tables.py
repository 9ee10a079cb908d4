"""Arrays of .npz and .mat files as a table."""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError
from stribeck.recording.names import parse_name

if TYPE_CHECKING:
    import h5py

__all__ = ["read_mat", "read_npz"]

#: How many of the arrays that are left out are named.
_SHOWN = 6
#: An array of any type.
Array = NDArray[Any]


def _from_arrays(name: str, arrays: Mapping[str, Array]) -> tuple[pl.DataFrame, tuple[str, ...]]:
    """A table of the arrays of one length, and notes on those of other lengths.

    Of several lengths the one with a clock and a motion is taken, then the one with most arrays,
    then the largest.
    """
    columns: dict[str, Array] = {}
    for key, value in arrays.items():
        _spread(key, np.asarray(value), columns)
    lengths = Counter(len(column) for column in columns.values() if len(column) > 1)
    if not lengths:
        lengths = Counter(len(column) for column in columns.values())
    if not lengths:
        raise RecordingError(f"{name}: holds no arrays of numbers")

    def worth(n: int) -> tuple[bool, int, int]:
        channels = {parse_name(key).channel for key, c in columns.items() if len(c) == n}
        recorded = "time" in channels and not channels.isdisjoint(("position", "velocity"))
        return recorded, lengths[n], n

    length = max(lengths, key=worth)
    left = {key: len(column) for key, column in columns.items() if len(column) not in (1, length)}
    table = pl.DataFrame({key: c for key, c in columns.items() if len(c) == length})
    return table, _left_out(left, length)


def _left_out(left: Mapping[str, int], length: int) -> tuple[str, ...]:
    """A note on the arrays of other lengths, the longest first."""
    if not left:
        return ()
    listed = sorted(left, key=lambda key: -left[key])
    shown = ", ".join(f"{key} ({left[key]})" for key in listed[:_SHOWN])
    more = f" and {len(listed) - _SHOWN} more" if len(listed) > _SHOWN else ""
    what = "1 array is" if len(left) == 1 else f"{len(left)} arrays are"
    return (f"{what} left out, not {length} long: {shown}{more}",)


def _spread(key: str, value: Array, columns: dict[str, Array]) -> None:
    if value.dtype.names:
        # The fields of a struct are columns; MATLAB stores a struct as an array of one.
        for field in value.dtype.names:
            inner = value[field]
            if inner.dtype == object and inner.size == 1:
                inner = np.asarray(inner.reshape(-1)[0])
            found: dict[str, Array] = {}
            _spread(field, inner, found)
            for column, values in found.items():
                there = columns.get(column)
                same = there is None or np.array_equal(there, values)
                # Fields of two structs may have one name.
                columns[column if same else f"{key}.{column}"] = values
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
        # One column per joint; the long side is time.
        table = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
        for i in range(table.shape[1]):
            columns[f"{key}_{i + 1}"] = np.ascontiguousarray(table[:, i])


def read_npz(name: str, data: bytes) -> tuple[pl.DataFrame, tuple[str, ...]]:
    """The table of a .npz file, and notes on what is left out."""
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {key: archive[key] for key in archive.files}
    except Exception as error:  # the zip and pickle layers raise many kinds
        reason = str(error).splitlines()[0][:100] if str(error) else type(error).__name__
        raise RecordingError(
            f"{name}: is not a whole .npz file ({reason}): write it again"
        ) from None
    return _from_arrays(name, arrays)


def read_mat(name: str, data: bytes) -> tuple[pl.DataFrame, tuple[str, ...]]:
    """The table of a .mat file of any version, and notes on what is left out."""
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


def _read_mat73(name: str, data: bytes) -> tuple[pl.DataFrame, tuple[str, ...]]:
    try:
        import h5py
    except ImportError:
        raise RecordingError(
            f"{name}: is a MATLAB 7.3 file, which needs h5py: install it (pip install h5py), "
            "or save with -v7 in MATLAB"
        ) from None
    arrays: dict[str, Array] = {}
    try:
        with h5py.File(io.BytesIO(data), "r") as file:

            def take(key: str, item: h5py.Group | h5py.Dataset) -> None:
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
