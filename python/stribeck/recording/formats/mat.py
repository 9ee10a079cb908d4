"""MATLAB's .mat files: versions 4 to 7 by SciPy, 7.3 as HDF5."""

from __future__ import annotations

import io
import struct
import warnings
import zlib

import numpy as np
import scipy

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.arrays import Array, read_arrays
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.hdf5 import read_hdf5
from stribeck.recording.formats.part import Read

__all__ = ["read_mat"]

#: The header of version 5 and later; type of a compressed element; most that deflate can expand.
_HEADER, _COMPRESSED, _MOST_EXPANSION = 128, 15, 1032
#: Bytes that are decompressed at a time.
_PIECE = 1 << 16


def read_mat(file: Entered, asked: Asked) -> Read:
    """The arrays of a .mat file of any version.

    Raises
    ------
    RecordingError
        The file is damaged, too large for memory, or of version 7.3 without h5py.
    """
    with file.open() as stream:
        start = stream.read(520)
    if start[:10] == b"MATLAB 7.3" or b"\x89HDF\r\n\x1a\n" in (start[:8], start[512:520]):
        return read_hdf5(file, asked, kind=".mat")
    data = file.data
    try:
        _check_size(file, data)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            loaded = scipy.io.loadmat(io.BytesIO(data), verify_compressed_data_integrity=False)
    except RecordingError:
        raise
    except Exception as error:  # scipy raises many kinds on damaged files
        raise file.damaged(".mat", error, "save it again") from None
    arrays: dict[str, Array] = {}
    unread: list[str] = []
    for key, value in loaded.items():
        kind = type(value).__name__
        if kind in ("MatlabOpaque", "MatlabFunction", "MatlabObject") or key == "None":
            unread.append(f"{_object_name(key, value)} (a MATLAB object)")
        elif not key.startswith("__"):
            arrays[key] = value
    return read_arrays(file, arrays, asked, unread)


def _object_name(key: str, value: Array) -> str:
    """The name of an object: those of classes have none of their own."""
    names = value.dtype.names or ()
    if "s0" in names:
        first = np.reshape(value["s0"], -1)[0]
        return first.decode(errors="replace") if isinstance(first, bytes) else str(first)
    return key


def _check_size(file: Entered, data: bytes) -> None:
    """Refuse compressed elements that are too large, by decompressing without keeping."""
    if len(data) * _MOST_EXPANSION <= file.most or len(data) < _HEADER:
        return
    order = "<" if data[126:128] == b"IM" else ">"
    at, total = _HEADER, 0
    while at + 8 <= len(data):
        kind, size = struct.unpack_from(f"{order}II", data, at)
        if kind == _COMPRESSED:
            total += _inflated(file, memoryview(data)[at + 8 : at + 8 + size], total)
        at += 8 + size


def _inflated(file: Entered, element: memoryview, before: int) -> int:
    """Bytes of an element after decompression."""
    inflate, size = zlib.decompressobj(), 0
    for first in range(0, len(element), _PIECE):
        piece: bytes = element[first : first + _PIECE].tobytes()
        while piece:
            size += len(inflate.decompress(piece, 1 << 22))
            file.refuse_above(before + size, "what the arrays hold")
            piece = inflate.unconsumed_tail
    return size
