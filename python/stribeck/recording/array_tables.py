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

if TYPE_CHECKING:
    import h5py

__all__ = ["read_mat", "read_npz"]

#: An array of any type.
Array = NDArray[Any]


def _from_arrays(name: str, arrays: Mapping[str, Array]) -> pl.DataFrame:
    """A table of the arrays that have the most common length."""
    columns: dict[str, Array] = {}
    for key, value in arrays.items():
        _spread(key, np.asarray(value), columns)
    lengths = Counter(len(column) for column in columns.values() if len(column) > 1)
    if not lengths:
        lengths = Counter(len(column) for column in columns.values())
    if not lengths:
        raise RecordingError(f"{name}: holds no arrays of numbers")
    length = max(lengths, key=lambda n: (lengths[n], n))
    return pl.DataFrame({key: column for key, column in columns.items() if len(column) == length})


def _spread(key: str, value: Array, columns: dict[str, Array]) -> None:
    if value.dtype.names:
        # The fields of a struct are columns; MATLAB stores a struct as an array of one.
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
        # One column per joint; the long side is time.
        table = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
        for i in range(table.shape[1]):
            columns[f"{key}_{i + 1}"] = np.ascontiguousarray(table[:, i])


def read_npz(name: str, data: bytes) -> pl.DataFrame:
    """The table of a .npz file."""
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {key: archive[key] for key in archive.files}
    except Exception as error:  # the zip and pickle layers raise many kinds
        reason = str(error).splitlines()[0][:100] if str(error) else type(error).__name__
        raise RecordingError(
            f"{name}: is not a whole .npz file ({reason}): write it again"
        ) from None
    return _from_arrays(name, arrays)


def read_mat(name: str, data: bytes) -> pl.DataFrame:
    """The table of a .mat file of any version."""
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
