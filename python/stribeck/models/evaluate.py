"""Torque and gradient of a compiled model, in an array that the caller keeps or a fresh one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stribeck import _core
from stribeck.base.checks import check_choice, shown
from stribeck.base.errors import SpecError
from stribeck.models.channels import Columns

Array = NDArray[np.float64]


def torque(
    core: _core.Model,
    spec: str,
    values: Array,
    read: Columns,
    state: float | ArrayLike,
    precision: str,
    out: Array | None,
) -> Array:
    """Torque of each sample, array [n], as `Model.torque` describes it."""
    check_choice("precision", precision, ("double", "single"))
    if out is not None:
        check_output(out, read["velocity"].shape, {**read, "state": state})
    single, what = precision == "single", f"the torque of {spec}"
    return core.torque(values, **read, state=state, single=single, out=out, what=what)


def gradient(
    core: _core.Model,
    spec: str,
    values: Array,
    read: Columns,
    state: float | ArrayLike,
    out: Array | None,
) -> Array:
    """Derivatives of the torque with respect to the parameters, array [n, p]."""
    both = None
    if out is not None:
        rows = read["velocity"].size
        check_output(out, (rows, values.size), {**read, "state": state})
        both = np.empty(rows), out
    _, found = core.gradient(values, **read, state=state, out=both, what=f"the gradient of {spec}")
    return found


def check_output(out: object, shape: tuple[int, ...], read: Mapping[str, object]) -> None:
    """Refuse an array that results of this shape cannot be written to.

    Parameters
    ----------
    out
        What a caller gives.
    shape
        Of the results.
    read
        Arguments of the call by name; `out` must share no memory with those that are arrays.

    Raises
    ------
    SpecError
        It is of another type, shape or layout, cannot be written to, or shares memory.

    Examples
    --------
    >>> check_output(np.zeros(3), (2,), {})
    Traceback (most recent call last):
    stribeck.base.errors.SpecError: `out` has the shape (3,): give an array of shape (2,)
    """
    if type(out) is not np.ndarray or out.dtype != np.float64:
        what = f"an array of {out.dtype.name}" if isinstance(out, np.ndarray) else shown(out)
        raise SpecError(f"`out` is {what}: give an array of float64")
    if out.shape != shape:
        raise SpecError(f"`out` has the shape {out.shape}: give an array of shape {shape}")
    if not out.flags.carray:
        raise SpecError(
            "`out` is not contiguous, row by row, or cannot be written to: give such an array"
        )
    for name, values in read.items():
        if isinstance(values, np.ndarray) and np.may_share_memory(out, values):
            raise SpecError(f"`out` shares memory with `{name}`: give another array")
