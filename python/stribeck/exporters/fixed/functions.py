"""Functions of one number as tables with linear interpolation, and bounds of its error.

Between two entries at a distance `h` the error of linear interpolation is at most ``h/4`` times the
change of the slope if the slope is monotonic, else ``h/2`` times. Where the slope has no bound the
error is at most the change of the function. With a second derivative of at most `c` it is at most
``c h^2/8``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Function:
    """A function of an array, with its slope.

    Attributes
    ----------
    value, slope
        The function and its derivative.
    turns
        Arguments at which the slope has an extremum; between them it is monotonic.
    settled
        Outside of this range the function is practically constant.
    curvature
        Bound of the second derivative; where it is given, no turns are needed.
    """

    value: Callable[[Array], Array]
    slope: Callable[[Array], Array]
    turns: tuple[float, ...] = ()
    settled: tuple[float, float] = (-np.inf, np.inf)
    curvature: float | None = None


def _root(exponent: float) -> Function:
    return Function(
        value=lambda x: np.sign(x) * np.abs(x) ** exponent,
        slope=lambda x: exponent * np.abs(x) ** (exponent - 1.0),
        turns=(0.0,),
    )


def _phi(x: Array) -> Array:
    safe = np.where(x == 0.0, 1.0, x)
    return np.where(x == 0.0, 1.0, np.expm1(safe) / safe)


def _phi_slope(x: Array) -> Array:
    safe = np.where(np.abs(x) < 1e-3, 1.0, x)
    return np.where(np.abs(x) < 1e-3, 0.5 + x / 3.0, (np.exp(safe) - _phi(safe)) / safe)


#: Functions by operation; below exp(-24) an exponential is smaller than 32 bits resolve.
FUNCTIONS: dict[str, Function] = {
    "exp": Function(np.exp, np.exp, settled=(-24.0, np.inf)),
    "expm1": Function(np.expm1, np.exp, settled=(-24.0, np.inf)),
    "ln": Function(np.log, lambda x: 1.0 / x),
    "sqrt": _root(0.5),
    "cbrt": _root(1.0 / 3.0),
    "tanh": Function(np.tanh, lambda x: 1.0 / np.cosh(x) ** 2, (0.0,), (-12.0, 12.0)),
    "sin": Function(np.sin, np.cos, curvature=1.0),
    "cos": Function(np.cos, lambda x: -np.sin(x), curvature=1.0),
    "phi": Function(_phi, _phi_slope),
    "atan": Function(np.arctan, lambda x: 1.0 / (1.0 + x * x), (0.0,)),
}


def power(exponent: float) -> Function:
    """``x^p`` for x that is not negative."""
    return _root(exponent)


@dataclass(frozen=True)
class Table:
    """Values of a function at equal distances.

    Attributes
    ----------
    start, cell
        Arguments in steps of their format: entry `k` is at ``start + k cell``.
    values
        The function at the entries.
    deviation
        Bound of the error of linear interpolation.
    steepness
        The largest slope between two entries.
    """

    start: int
    cell: int
    values: Array
    deviation: float
    steepness: float


def tabulate(function: Function, low: float, high: float, step: float, cells: int) -> Table:
    """The table of a function from `low` to `high`, with arguments in multiples of `step`.

    The number of steps in a cell is a power of two, so that interpolation needs no division.
    """
    first, last = int(np.floor(low / step)), int(np.ceil(high / step))
    cell = 1
    while (last - first) > cell * cells:
        cell *= 2
    count = -(-(last - first) // cell) + 1
    x: Array = (first + cell * np.arange(max(count, 2), dtype=np.float64)) * step
    with np.errstate(all="ignore"):
        values, slopes = function.value(x), function.slope(x)
    h = cell * step
    with np.errstate(invalid="ignore"):
        rise = np.abs(np.diff(values))
    off = _deviations(function, x, slopes, h)
    off = np.where(np.isfinite(off), np.minimum(off, rise), rise)
    return Table(first, cell, values, float(off.max()), float((rise / h).max()))


def _deviations(function: Function, x: Array, slopes: Array, h: float) -> Array:
    """Bounds of the interpolation error between entries; infinite where unknown."""
    if function.curvature is not None:
        return np.full(x.size - 1, function.curvature * h * h / 8.0)
    with np.errstate(all="ignore"):
        off = 0.25 * h * np.abs(np.diff(slopes))
        for turn in function.turns:
            inside = (x[:-1] <= turn) & (turn <= x[1:])
            there = function.slope(np.array([turn], dtype=np.float64))[0]
            around = np.maximum(np.abs(slopes[:-1] - there), np.abs(slopes[1:] - there))
            off = np.where(inside, 0.5 * h * around, off)
    return off
