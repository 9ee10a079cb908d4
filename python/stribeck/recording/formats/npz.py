"""NumPy's .npz files."""

from __future__ import annotations

import math
import zipfile
from typing import IO

import numpy as np

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.arrays import Array, read_arrays
from stribeck.recording.formats.door import Asked, Entered
from stribeck.recording.formats.part import Read

__all__ = ["read_npz"]


def read_npz(file: Entered, asked: Asked) -> Read:
    """The arrays of a .npz file; what every array needs is known before it is read.

    Raises
    ------
    RecordingError
        The file is damaged, too large for memory, or holds Python objects.
    """
    arrays: dict[str, Array] = {}
    try:
        with file.open() as stream, zipfile.ZipFile(stream) as archive:
            entries = [e for e in archive.infolist() if e.filename.endswith(".npy")]
            file.check_columns([entry.filename for entry in entries])
            file.refuse_above(sum(e.file_size for e in entries), "what the arrays hold")
            for entry in entries:
                with archive.open(entry) as member:
                    arrays[entry.filename.removesuffix(".npy")] = _array(file, entry, member)
    except RecordingError:
        raise
    except Exception as error:  # the zip layer raises many kinds
        raise file.damaged(".npz", error, "write it again") from None
    return read_arrays(file, arrays, asked, [])


def _array(file: Entered, entry: zipfile.ZipInfo, member: IO[bytes]) -> Array:
    """One array; its header must agree with the size of its entry."""
    version = np.lib.format.read_magic(member)
    header = {
        (1, 0): np.lib.format.read_array_header_1_0,
        (2, 0): np.lib.format.read_array_header_2_0,
    }.get(version)
    if header is None:
        raise ValueError(f"{entry.filename} has version {version} of the format")
    shape, fortran, dtype = header(member)
    if dtype.hasobject:
        raise RecordingError(
            f"{file.name}: '{entry.filename}' holds Python objects, which can run code when they "
            "are read: save arrays of numbers (dtype float)"
        )
    count = math.prod(shape)
    if count * dtype.itemsize > entry.file_size:
        raise ValueError(f"{entry.filename} is shorter than its header says")
    # One copy: the bytes are the array's memory.
    data = member.read(count * dtype.itemsize)
    made = np.frombuffer(data, dtype=dtype, count=count)
    return made.reshape(shape, order="F" if fortran else "C")
