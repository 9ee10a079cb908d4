"""Held-out blocks by the value of a column: a gain, a payload, a day."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.recording import Recording
from stribeck.recording.table import Prepared, labels, numbered

__all__ = ["with_hold_out"]


def with_hold_out(
    recording: Recording, prepared: Prepared, rows: NDArray[np.int64], said: str
) -> Recording:
    """The recording with one held-out block for each value of a column of its file.

    Parameters
    ----------
    rows
        Rows of the table that the recording was made of, [n].
    said
        ``"COLUMN"``, or ``"COLUMN=VALUE"`` where the held-out error of this value alone counts.

    Raises
    ------
    RecordingError
        No such column or value; a column with the same value in every row; averaged runs.
    """
    path, table = recording.path, prepared.table
    column, mark, value = (word.strip() for word in said.partition("="))
    if recording.averaged:
        raise RecordingError(f"{path}: --hold-out {said}: needs samples: leave --average out")
    if column not in table.columns:
        hint = nearest(column, table.columns) or f"; the file has {', '.join(table.columns)}"
        raise RecordingError(f"{path}: --hold-out {said}: there is no column '{column}'{hint}")
    names, block = numbered(labels(table[rows], column))
    if len(names) < 2:
        raise RecordingError(
            f"{path}: --hold-out {said}: every row has {column} {names[0]}: hold out by a column "
            "with several values"
        )
    if mark and value not in names:
        raise RecordingError(
            f"{path}: --hold-out {said}: no row has {column} {value}; there are "
            f"{', '.join(names[:20])}"
        )
    counted = block == names.index(value) if mark else np.ones(block.size, dtype=bool)
    block.flags.writeable = counted.flags.writeable = False
    return replace(
        recording, block=block, block_count=len(names), counted=counted,
        notes=(*recording.notes, _note(column, value, names)),
    )  # fmt: skip


def _note(column: str, value: str, values: list[str]) -> str:
    if value:
        return f"held out: the rows with {column} {value}, predicted from all others"
    return f"held out: each {column} in turn ({', '.join(values[:20])})"
