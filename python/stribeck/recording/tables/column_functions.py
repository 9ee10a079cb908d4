"""Functions of formulas over columns that no friction law has: they see more than one sample."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import polars as pl

from stribeck.recording.arrays import Floats

__all__ = ["Over", "choose", "interpolated", "of_all", "table_problem"]


@dataclass(frozen=True)
class Over:
    """How functions of all samples are computed, on arrays with one value per row of the table.

    Attributes
    ----------
    diff
        Derivative by time.
    mean
        Mean over the rows of a joint.
    """

    diff: Callable[[Floats], Floats]
    mean: Callable[[Floats], Floats]


def of_all(compute: Callable[[Floats], Floats], rows: int) -> Callable[[pl.Expr], pl.Expr]:
    """A function of all samples as a function of an expression."""

    def run(series: pl.Series) -> pl.Series:
        values = series.cast(pl.Float64).fill_null(np.nan).to_numpy()
        # An expression without a column has one value.
        values = values if values.size == rows else np.full(rows, values[0])
        return pl.Series(compute(values))

    return lambda x: x.map_batches(run, return_dtype=pl.Float64)


def choose(condition: pl.Expr, one: pl.Expr, other: pl.Expr) -> pl.Expr:
    """`one` where the condition holds, `other` where it does not, missing where it is missing."""
    missing = pl.when(condition.is_null()).then(None)
    return missing.when(condition).then(one).otherwise(other)


def table_problem(points: list[float | None]) -> str | None:
    """What is wrong with the points x1, y1, x2, y2 ... of a table; None where nothing is.

    Examples
    --------
    >>> table_problem([0.0, 1.0, 2.0, 3.0])
    >>> table_problem([2.0, 1.0, 0.0, 3.0])
    'the points of interp must be in increasing order of x'
    """
    if len(points) % 2:
        return "interp takes a value and points in pairs, interp(x, x1, y1, x2, y2, ...),"
    if None in points:
        return "the points of interp must be numbers"
    at = [x for x in points[::2] if x is not None]
    if any(b <= a for a, b in itertools.pairwise(at)):
        return "the points of interp must be in increasing order of x"
    return None


def interpolated(x: pl.Expr, points: list[float]) -> pl.Expr:
    """Straight lines between the points x1, y1, x2, y2 ...; beyond them, the first or last y."""

    def run(series: pl.Series) -> pl.Series:
        values = series.fill_null(np.nan).to_numpy()
        return pl.Series(np.interp(values, points[::2], points[1::2]))

    return x.map_batches(run, return_dtype=pl.Float64)
