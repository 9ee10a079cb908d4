"""Weights of the samples: a column or formula of the file, or an array."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Floats, Ints, floats
from stribeck.recording.recording import Recording
from stribeck.recording.tables.computed import column_of
from stribeck.recording.tables.readers import Source

__all__ = ["check_scored_weights", "refuse_weights", "table_weights", "with_weights"]


def table_weights(source: Source, table: pl.DataFrame, row: Ints, text: str) -> Floats:
    """The weight of each row of a table.

    Parameters
    ----------
    row
        Numbers of the rows in the file, from 0.
    text
        A column, or a formula of columns.

    Raises
    ------
    RecordingError
        The formula cannot be used, or a weight is negative or not finite.
    """
    where = f"{source.path}: {option('weights', text)}"
    values = column_of(source, table, text, where)
    wrong = np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))
    if wrong.size:
        found = values[wrong[0]]
        what = "empty or not a number" if np.isnan(found) else f"{found:g}"
        raise RecordingError(
            f"{where}: the weight in {source.place(int(row[wrong[0]]))} is {what}: give finite "
            f"weights of at least 0, or leave the row out with {option('where')}"
        )
    return values


def with_weights(recording: Recording, weights: ArrayLike | None) -> Recording:
    """`recording` with the weight of each sample, [n]; None keeps its own.

    Raises
    ------
    RecordingError
        There are more or fewer weights than samples, one is negative or not finite, or all of the
        scored ones are 0.
    """
    if weights is None:
        return recording
    try:
        values = floats(weights)
    except (TypeError, ValueError):
        raise RecordingError(f"{option('weights')}: give one number for each sample") from None
    if values.shape != (recording.rows,):
        given = " x ".join(map(str, values.shape)) or "1"
        raise RecordingError(
            f"{recording.path}: {given} weights for {recording.rows} samples: give one for each"
        )
    wrong = np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))
    if wrong.size:
        raise RecordingError(
            f"{recording.path}: weight {wrong[0]} is {values[wrong[0]]:g}: give finite weights of "
            "at least 0"
        )
    made = replace(recording, weight=values, unweighted=recording)
    check_scored_weights(made)
    return made


def refuse_weights(what: str, *recordings: Recording) -> None:
    """Raise `RecordingError` if samples have weights, which `what` does not use."""
    if any(recording.weight is not None for recording in recordings):
        raise RecordingError(f"{what} does not use weights: leave out {option('weights')}")


def check_scored_weights(recording: Recording) -> None:
    """Raise `RecordingError` if the weights of all scored samples are 0."""
    if recording.weight is not None and not recording.weight[recording.moving].any():
        raise RecordingError(f"{recording.path}: the weights of all scored samples are 0")
