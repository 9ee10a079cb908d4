"""Curves as text: marks on a grid of characters, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stribeck.report.layout import line_width
from stribeck.report.numbers import plain

__all__ = ["MARKS", "text_plot"]

Array = NDArray[np.float64]

#: One mark for each curve.
MARKS = "•+x"
#: Most columns of the grid, and its rows.
COLUMNS, ROWS = 61, 15
#: Spaces before each line, and those that the labels of an axis may take.
_INDENT, _LABELS = 2, 12


def text_plot(
    curves: Sequence[tuple[Array, Array]], x_label: str, y_label: str, *, log: bool = False
) -> str:
    """Draw curves on a grid of characters.

    Parameters
    ----------
    curves
        Arrays [n] of x and y of each, drawn with `MARKS` in turn; values that are not finite are
        left out.
    x_label, y_label
        What the axes show, with units.
    log
        Whether x, then positive, is drawn on a logarithmic scale.

    Examples
    --------
    >>> v = np.linspace(-1.0, 1.0, 61)
    >>> text_plot([(v, np.sign(v))], "velocity [rad/s]", "torque [N m]").count("•")
    61
    """
    drawn = [_finite(x, y, log) for x, y in curves]
    every_x = np.concatenate([x for x, _ in drawn])
    every_y = np.concatenate([y for _, y in drawn])
    if every_x.size == 0:
        return ""
    left, right = float(every_x.min()), float(every_x.max())
    low, high = _range(every_y)
    columns = min(COLUMNS, line_width() - _INDENT - _LABELS)
    grid = np.full((ROWS, columns), " ")
    if low < 0.0 < high:
        grid[_place(np.array([0.0]), high, low, ROWS)] = "·"
    for k, (x, y) in enumerate(drawn):
        grid[_place(y, high, low, ROWS), _place(x, left, right, columns)] = MARKS[k % len(MARKS)]
    labels = {0: plain(high), ROWS - 1: plain(low)}
    if low < 0.0 < high:
        labels.setdefault(int(_place(np.array([0.0]), high, low, ROWS)[0]), "0")
    wide = max(map(len, labels.values()))
    side = " " * _INDENT
    lines = [f"{side}{y_label}"]
    lines += [
        f"{side}{labels.get(row, ''):>{wide}} {'┤' if row in labels else '│'}{''.join(grid[row])}"
        for row in range(ROWS)
    ]
    ends = [10.0**left, 10.0**right] if log else [left, right]
    first, last = map(plain, ends)
    under = " " * (_INDENT + wide + 1)
    lines.append(f"{under}└{'─' * columns}")
    between = columns - len(first) - len(last)
    lines.append(f"{under} {first}{x_label.center(between)}{last}")
    return "\n".join(line.rstrip() for line in lines)


def _finite(x: Array, y: Array, log: bool) -> tuple[Array, Array]:
    known = np.isfinite(x) & np.isfinite(y)
    if log:
        known &= x > 0.0
    return (np.log10(x[known]) if log else x[known]), y[known]


def _range(y: Array) -> tuple[float, float]:
    """The ends of the axis; it holds 0, so that sizes can be compared."""
    low, high = min(0.0, float(y.min())), max(0.0, float(y.max()))
    # An end that is nearly 0 is drawn as 0, where it has the row of 0 anyway.
    low, high = (0.0 if abs(end) < 0.5 / ROWS * (high - low) else end for end in (low, high))
    return (low, high) if high > low else (low, low + 1.0)


def _place(values: Array, first: float, last: float, count: int) -> NDArray[np.intp]:
    """The cells of values between the first and the last one."""
    share = (values - first) / ((last - first) or 1.0)
    return np.clip(np.rint(share * (count - 1)), 0, count - 1).astype(np.intp)
