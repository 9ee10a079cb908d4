"""Arrays of a recording: read-only copies."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Bools", "Floats", "Ints", "Numbers", "bools", "floats", "floats_or_none", "ints"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Numbers = NDArray[Any]


def floats(values: ArrayLike) -> Floats:
    """A read-only copy, float64."""
    array = np.array(values, dtype=np.float64, order="C")
    array.flags.writeable = False
    return array


def floats_or_none(values: Floats | None) -> Floats | None:
    """A read-only copy, float64; None stays None."""
    return None if values is None else floats(values)


def ints(values: ArrayLike) -> Ints:
    """A read-only copy, int64."""
    array = np.array(values, dtype=np.int64, order="C")
    array.flags.writeable = False
    return array


def bools(values: ArrayLike) -> Bools:
    """A read-only copy, bool."""
    array = np.array(values, dtype=np.bool_, order="C")
    array.flags.writeable = False
    return array
