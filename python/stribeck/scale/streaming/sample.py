"""Evenly spaced contiguous parts of a data set, as one recording in memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, option
from stribeck.recording.assembly.assemble import build
from stribeck.recording.motion.excerpt import stretches
from stribeck.recording.naming.columns import Choice
from stribeck.recording.recording import Recording
from stribeck.recording.stated.settings import Settings
from stribeck.recording.tables.readers import Source
from stribeck.recording.whole_file.table import Prepared, joint_rows, prepared_table
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.runs import block_edges, run_starts

__all__ = ["Sample", "take"]

Ints = NDArray[np.int64]

#: Column that numbers the runs if only their times separate them.
CLOCK_RUN = "run of the clock"


@dataclass(frozen=True)
class Sample:
    """The samples of a data set in memory, and how the other samples are read.

    Attributes
    ----------
    recording
        The contiguous parts, with gaps between them.
    prepared
        Their table, with the columns chosen for the channels.
    joint
        The joint read, if the files hold several.
    starts, edges
        First rows of the runs and of the held-out blocks; `edges` ends with the number of all rows.
    """

    recording: Recording
    prepared: Prepared
    joint: str | None
    starts: Ints
    edges: Ints

    @property
    def whole(self) -> bool:
        """Whether it contains all samples of the data set."""
        return self.prepared.source.table.height == int(self.edges[-1])


class _Rows(Source):
    """Rows of a data set, named by their file and row there."""

    def __init__(self, data: DataSet, table: pl.DataFrame) -> None:
        super().__init__(data.path, "", table, 0)
        self._data = data

    def place(self, row: int) -> str:
        """Name a row (counted from 0)."""
        return self._data.place(row)


def take(data: DataSet, settings: Settings, most: int, seed: int) -> Sample:
    """Read at most `most` samples of a data set.

    Raises
    ------
    RecordingError
        The recording is invalid, or an option needs all samples at once.
    """
    _refuse(data, settings)
    taken = stretches(data.rows, most, seed)
    table = pl.concat([data.frame(*stretch) for stretch in taken])
    number = np.concatenate([np.arange(*stretch) for stretch in taken])
    prepared = prepared_table(_Rows(data, table), settings)
    starts = _starts(data, prepared)
    row = number[prepared.row]
    prepared = _with_runs(replace(prepared, row=row), row, starts, tuple(dict.fromkeys(data.runs)))
    joint, own = joint_rows(prepared, settings.joint)
    # To build a recording makes a current the torque, which each window does again.
    recording = build(replace(prepared, choices=dict(prepared.choices)), joint, own, mend=False)
    recording.require_consistent()
    edges = block_edges(data.rows, starts)
    return Sample(recording, prepared, joint, starts, edges)


def _refuse(data: DataSet, settings: Settings) -> None:
    """Raise RecordingError for options that need all samples at once."""
    for name in ("average", "drive", "hold_out"):
        value: str | None = getattr(settings, name)
        if value is not None:
            raise RecordingError(
                f"{data.path}: {option(name, value)} needs all samples in memory: leave it out, or "
                "read one file into memory, without streaming"
            )
    if settings.weights is not None:
        raise RecordingError(
            f"{data.path}: weights need all samples in memory: leave out {option('weights')}, or "
            "give one file that is not read in passes"
        )
    if settings.unwrap:
        raise RecordingError(
            f"{data.path}: {option('unwrap')} needs all samples in memory: write the position "
            "without jumps, or read one file into memory"
        )


def _starts(data: DataSet, prepared: Prepared) -> Ints:
    time, run = prepared.choices.get("time"), prepared.choices.get("run")
    for choice in (time, run):
        if choice is not None and choice.source not in data.schema:
            raise RecordingError(
                f"{data.path}: '{choice.source}' is derived, but a streamed data set "
                f"needs the {choice.channel} as a column: write it into the files"
            )
    if time is None:
        return np.zeros(1, dtype=np.int64)
    if run is None and data.runs:
        return data.first[[data.runs.index(name) for name in dict.fromkeys(data.runs)]]
    return run_starts(data, None if run is None else run.source, time.source)


def _with_runs(prepared: Prepared, row: Ints, starts: Ints, names: Sequence[str] = ()) -> Prepared:
    """Number or name the runs if there are several and no column numbers them."""
    if "run" in prepared.choices or starts.size < 2:
        return prepared
    number = pl.Series(CLOCK_RUN, np.searchsorted(starts, row, side="right"))
    choices = {**prepared.choices, "run": Choice("run", CLOCK_RUN, None, "name")}
    if names:
        named = pl.Series(CLOCK_RUN, [names[k - 1] for k in number])
        return replace(prepared, table=prepared.table.with_columns(named), choices=choices)
    note = f"the clock starts again in {starts.size - 1} files: each of them begins a run"
    return replace(
        prepared,
        table=prepared.table.with_columns(number),
        choices=choices,
        notes=(*prepared.notes, note),
    )
