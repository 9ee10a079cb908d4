"""HDF5 files, and MATLAB's of version 7.3."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stribeck.base.errors import RecordingError
from stribeck.recording.formats.arrays import Array, read_arrays
from stribeck.recording.formats.door import Asked, Entered, missing_library
from stribeck.recording.formats.names import with_unit
from stribeck.recording.formats.part import Read

if TYPE_CHECKING:
    import h5py

__all__ = ["read_hdf5"]

#: Attributes of a dataset that name its unit.
_UNITS = ("units", "unit", "Units", "Unit")


def read_hdf5(file: Entered, asked: Asked, kind: str = "HDF5") -> Read:
    """The datasets of an HDF5 file; what each needs is known before it is read.

    Links to other files are not followed.

    Raises
    ------
    RecordingError
        The file is damaged or too large for memory, or h5py is not installed.
    """
    try:
        import h5py
    except ImportError:
        what = "MATLAB 7.3" if kind == ".mat" else kind
        raise missing_library(file.name, what, "h5py") from None
    unread: list[str] = []
    try:
        with file.open() as stream, h5py.File(stream, "r") as content:
            found = _datasets(content, unread)
            file.check_columns(list(found))
            file.refuse_above(sum(d.nbytes for d in found.values()), "what the datasets hold")
            arrays: dict[str, Array] = {}
            for key, dataset in found.items():
                arrays[with_unit(key, _unit(dataset))] = _values(dataset)
    except RecordingError:
        raise
    except Exception as error:  # h5py raises many kinds on damaged files
        remedy = "save it again" if kind == ".mat" else "write it again"
        raise file.damaged(kind, error, remedy) from None
    return read_arrays(file, arrays, asked, unread)


def _datasets(content: h5py.File, unread: list[str]) -> dict[str, h5py.Dataset]:
    """Datasets of numbers or texts by the end of their path, as long as no other has it."""
    import h5py

    found: dict[str, h5py.Dataset] = {}

    def take(path: str, item: h5py.Group | h5py.Dataset) -> None:
        # MATLAB keeps the cells of cell arrays and objects in groups of their own.
        if not isinstance(item, h5py.Dataset) or path.startswith("#"):
            return
        if item.dtype.kind not in "biufSV" and h5py.check_string_dtype(item.dtype) is None:
            unread.append(path)
        elif item.external or item.is_virtual:
            unread.append(f"{path} (in another file)")
        elif item.shape:
            name = path.rsplit("/", 1)[-1]
            found[path.replace("/", ".") if name in found else name] = item

    content.visititems(take)
    return found


def _values(dataset: h5py.Dataset) -> Array:
    """The values; MATLAB's texts are numbers there."""
    values = dataset[()]
    if values.dtype.kind == "O":
        return np.array([str(v, "utf-8", "replace") for v in values.reshape(-1)])
    return values


def _unit(dataset: h5py.Dataset) -> str | None:
    """The unit that an attribute names."""
    for name in _UNITS:
        value = dataset.attrs.get(name)
        if isinstance(value, bytes):
            return value.decode(errors="replace")
        if isinstance(value, str):
            return value
    return None
