"""What is in a file before a joint is selected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.base.units import SI
from stribeck.recording.joint.required import require
from stribeck.recording.naming.names import CHANNELS, file_unit, wide_groups
from stribeck.recording.recording import Column
from stribeck.recording.rows import segment_rows
from stribeck.recording.stated.options import ReadArguments, ReadOptions
from stribeck.recording.stated.settings import Settings, gather
from stribeck.recording.tables.cells import column_numbers, labels, numbered
from stribeck.recording.tables.computed import apply_formulas
from stribeck.recording.tables.readers import read_table
from stribeck.recording.whole_file.derived_columns import Whole
from stribeck.recording.whole_file.table import Prepared, channel_values, joints_of, prepare

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["FileColumn", "Table", "scan", "scan_with"]


@dataclass(frozen=True)
class FileColumn:
    """A column as the file has it.

    Attributes
    ----------
    unit
        Named in the column's name.
    minimum, maximum
        Range of its numbers.
    missing
        Cells that are empty, NaN or infinite.
    channel
        That the column is read for.
    """

    name: str
    dtype: str
    unit: str | None
    minimum: float | None
    maximum: float | None
    missing: int
    derived: bool
    channel: str | None


@dataclass(frozen=True)
class Table:
    """What is in a file before a joint is selected.

    Attributes
    ----------
    rows
        Rows for which `where` holds.
    joints
        Joints of a joint column, or the joint numbers of a wide file.
    columns
        Every column of the file.
    channels
        Channel -> column read for it, unit and range in SI.
    problem
        Why a joint cannot be read, as far as the columns tell; None where it can.
    """

    path: str
    sha256: str
    rows: int
    joints: tuple[str, ...]
    wide: bool
    runs: int
    columns: tuple[FileColumn, ...]
    channels: dict[str, Column]
    rate_hz: float | None
    gaps: int | None
    problem: str | None
    notes: tuple[str, ...]


def scan(path: str | Path, **options: Unpack[ReadArguments]) -> Table:
    """Look at a file without selecting a joint; see `read` for the options.

    Raises
    ------
    RecordingError
        The file cannot be opened, or an option or formula is wrong.
    """
    return scan_with(path, ReadOptions.of(options))


def scan_with(path: str | Path, options: ReadOptions) -> Table:
    """Look at a file without selecting a joint; see `scan`."""
    prepared, problem = _prepared(str(path), gather(path, options))
    table, choices = prepared.table, prepared.choices
    wide = wide_groups(table.columns) if not choices else {}
    joints = tuple(joints_of(prepared)) or tuple(next(iter(wide.values()), {}))
    used = {choice.source: channel for channel, choice in choices.items()}
    channels, wrong = _channels(prepared)
    runs, rate, gaps = _pace(prepared)
    return Table(
        path=prepared.source.path,
        sha256=prepared.source.sha256,
        rows=table.height,
        joints=joints,
        wide=bool(wide),
        runs=runs,
        columns=tuple(
            _file_column(table[name], name in prepared.derived, used.get(name))
            for name in table.columns
        ),
        channels=channels,
        rate_hz=rate,
        gaps=gaps,
        problem=problem or wrong,
        notes=prepared.notes,
    )


def _prepared(path: str, settings: Settings) -> tuple[Prepared, str | None]:
    """The table, and why it could not be read as a recording; then it has no channels."""
    try:
        prepared = prepare(path, settings)
        require(prepared)
    except RecordingError as error:
        # A file that cannot be opened, or a wrong formula, is refused here as it is by `read`.
        source = read_table(path, settings.asked)
        made = apply_formulas(source, settings, Whole(source, settings))
        return Prepared(source, settings, made.table, made.row, {}, made.notes), str(error)
    return prepared, None


def _channels(prepared: Prepared) -> tuple[dict[str, Column], str | None]:
    """The channels that hold numbers, and what is wrong with the first of the others."""
    channels: dict[str, Column] = {}
    problem: str | None = None
    slides = prepared.settings.joint_kind == "prismatic" or any(
        choice.unit is not None and choice.unit.dimension.startswith(("length", "linear", "force"))
        for choice in prepared.choices.values()
    )
    for channel, choice in prepared.choices.items():
        if channel in ("joint", "run"):
            continue
        rows = np.arange(prepared.table.height)
        try:
            values, unit_named, _ = channel_values(prepared, channel, rows)
        except RecordingError as error:
            problem = problem or str(error)
            continue
        finite = values[np.isfinite(values)]
        dimensions = CHANNELS[channel]
        # A channel's list begins with angle or torque, then length or force; a switch has none.
        si = unit_named or "1"
        if not unit_named and dimensions:
            si = SI[dimensions[1 if slides and len(dimensions) > 1 else 0]]
        if finite.size:
            derived = choice.source in prepared.derived
            channels[channel] = Column.of(channel, choice.source, si, derived, finite)
    return channels, problem


def _file_column(series: pl.Series, derived: bool, channel: str | None) -> FileColumn:
    unit = file_unit(series.name)
    low = high = None
    missing = series.null_count()
    if series.dtype.is_numeric():
        values = series.cast(pl.Float64).drop_nulls().to_numpy()
        finite = values[np.isfinite(values)]
        missing += len(values) - len(finite)
        if finite.size:
            low, high = float(finite.min()), float(finite.max())
    return FileColumn(
        series.name,
        str(series.dtype),
        unit.name if unit else None,
        low,
        high,
        int(missing),
        derived,
        channel,
    )


def _pace(prepared: Prepared) -> tuple[int, float | None, int | None]:
    """Runs, sampling rate and gaps over every joint of a file."""
    choices = prepared.choices
    if "time" not in choices:
        return 1, None, None
    try:
        time = column_numbers(prepared.source, prepared.table, prepared.row, choices["time"].source)
    except RecordingError:
        return 1, None, None
    # Infinite cells are refused with the missing ones when the recording is read.
    time = np.where(np.isinf(time), np.nan, time)
    if choices["time"].unit is not None:
        time = time * choices["time"].unit.factor
    code = np.zeros(len(time), dtype=np.int64)
    for channel in ("joint", "run"):
        if channel in choices:
            names, number = numbered(labels(prepared.table, choices[channel].source))
            code = code * len(names) + number
    order = np.argsort(code, kind="stable")
    segment, _, typical = segment_rows(time[order], code[order], prepared.row[order])
    runs = np.unique(code).size
    gaps = int(segment[-1]) + 1 - runs
    return runs, 1.0 / typical if typical > 0.0 else None, gaps
