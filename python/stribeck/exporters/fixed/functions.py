"""Functions of one number as tables with straight lines between, and how far these are off.

Between two entries a distance `h` apart a straight line is off by no more than ``h/4`` times what
the slope changes by in between if the slope grows or falls throughout, else ``h/2`` times; where
the slope has no bound, by no more than the function changes. Of a known curvature `c` it is
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
    """A function that grows or falls throughout on each side of its `turns`.

    Attributes
    ----------
    value, slope
        Of an array.
    turns
        Where its slope has an extreme.
    curvature
        What its second derivative never exceeds; where it is known, no turns are needed.
    settled
        Outside of this range it is as good as constant.
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


#: Functions by operation; 24 bits are as many as a result of 32 bits shows of an exponential's end.
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
    """``x^p`` of numbers that are not negative."""
    return _root(exponent)


@dataclass(frozen=True)
class Table:
    """Values at equal distances.

    Attributes
    ----------
    start, cell
        Of the argument, in its smallest steps: entry `k` stands at ``start + k cell``.
    values
        The function there.
    deviation
        How far a straight line between two entries is off at most.
    steepness
        The largest slope between two entries.
    """

    start: int
    cell: int
    values: Array
    deviation: float
    steepness: float


def tabulate(function: Function, low: float, high: float, step: float, cells: int) -> Table:
    """The table of a function between two arguments, in smallest steps of the argument `step`.

    A cell is a power of two of steps, so that a place in it needs no division.
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
    """How far a straight line between each two entries is off at most; infinite where unknown."""
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
