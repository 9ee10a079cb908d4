"""Held-out blocks by the value of a column: a gain, a payload, a day."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import RecordingError, listed, nearest, option
from stribeck.recording.arrays import Ints, bools, ints
from stribeck.recording.joint.channels import Layout
from stribeck.recording.recording import Recording
from stribeck.recording.tables.cells import labels, numbered
from stribeck.recording.tables.prepared import Prepared

__all__ = ["with_hold_out"]


def with_hold_out(
    recording: Recording, prepared: Prepared, rows: Ints, given: str, layout: Layout
) -> Recording:
    """The recording with one held-out block for each value of a column of its file.

    Parameters
    ----------
    rows
        Rows of the table that the recording was made of, [n].
    given
        ``"COLUMN"``, or ``"COLUMN=VALUE"`` to take the held-out error of this value alone.
    layout
        Says to which run each of the rows belongs, where each point is the average of a run.

    Raises
    ------
    RecordingError
        No such column or value, a column with the same value in every row, or one that changes
        within a run of which one point is made.
    """
    path, table = recording.path, prepared.table
    column, mark, value = (word.strip() for word in given.partition("="))
    where = f"{path}: {option('hold_out', given)}"
    if column not in table.columns:
        hint = nearest(column, table.columns) or f"; the file has {listed(table.columns)}"
        raise RecordingError(f"{where}: there is no column '{column}'{hint}")
    names, block = numbered(labels(table[rows], column))
    if len(names) < 2:
        raise RecordingError(
            f"{where}: every row has {column} {names[0]}: hold out by a column with several values"
        )
    if mark and value not in names:
        raise RecordingError(
            f"{where}: no row has {column} {value}; there are {', '.join(names[:20])}"
        )
    if recording.averaged:
        block = _of_runs(block, layout, f"{where}: {column}")
    counted = block == names.index(value) if mark else np.ones(block.size, dtype=bool)
    return replace(
        recording,
        block=ints(block),
        block_count=len(names),
        counted=bools(counted),
        notes=(*recording.notes, _note(column, value, names)),
    )


def _of_runs(block: Ints, layout: Layout, what: str) -> Ints:
    """The block of each run, from the blocks of its samples."""
    starts = np.flatnonzero(np.diff(layout.run, prepend=-1))
    of_run = block[starts]
    length = np.diff(starts, append=block.size)
    changes = np.flatnonzero(block != np.repeat(of_run, length))
    if changes.size:
        name = layout.run_names[layout.run[changes[0]]]
        raise RecordingError(
            f"{what} changes within run {name}, of which one point is made: hold out by a column "
            f"that is constant in every run, or leave out {option('average')}"
        )
    return of_run


def _note(column: str, value: str, values: list[str]) -> str:
    if value:
        return f"held out: the samples with {column} {value}, predicted from all others"
    return f"held out: each {column} in turn ({', '.join(values[:20])})"
