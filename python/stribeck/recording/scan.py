"""What `scan` finds: what is in a file before a joint is selected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError
from stribeck.recording.assemble import make_column, require
from stribeck.recording.columns import CHANNELS, file_unit, wide_groups
from stribeck.recording.options import Pairs, gather
from stribeck.recording.readers import read_table
from stribeck.recording.recording import Column
from stribeck.recording.rows import segment_rows
from stribeck.recording.table import (
    Prepared,
    apply_formulas,
    channel_values,
    column_numbers,
    joints_of,
    labels,
    numbered,
    prepare,
)
from stribeck.recording.units import SI

__all__ = ["FileColumn", "Table", "scan"]


@dataclass(frozen=True)
class FileColumn:
    """A column as the file has it: its type, the unit its name carries, its range and empty "
    "cells."""

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
        Rows that `where` leaves.
    joints
        Joints of a joint column, or the joint numbers of a wide file.
    columns
        Every column of the file.
    channels
        Channel -> column read for it, unit and range in SI.
    problem
        The sentence with which reading a joint would be refused, as far as the columns tell.
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


def scan(
    path: str | Path,
    *,
    sidecar: str | Path | None = None,
    joint: str | None = None,
    joint_kind: str | None = None,
    gear_ratio: float | None = None,
    torque_constant: float | None = None,
    inertia: float | None = None,
    km: float | None = None,
    kb: float | None = None,
    kt: float | None = None,
    unit: Pairs = (),
    map: Pairs = (),
    derive: Pairs = (),
    where: str | None = None,
    average: str | None = None,
    drive: str | None = None,
    hold_out: str | None = None,
    rows: str | None = None,
) -> Table:
    """Look at a file without selecting a joint; see `read` for the options."""
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, km=km, kb=kb, kt=kt, unit=unit, map=map,
        derive=derive, where=where, average=average, drive=drive, hold_out=hold_out,
        rows=rows,
    )  # fmt: skip
    problem: str | None = None
    prepared: Prepared | None
    try:
        prepared = prepare(str(path), options)
        source, table = prepared.source, prepared.table
        require(prepared)
    except RecordingError as error:
        problem = str(error)
        # A file that cannot be opened, or a wrong formula, is refused here as it is by `read`.
        source = read_table(str(path))
        table, row, derived, _, notes = apply_formulas(source, options)
        prepared = Prepared(
            source,
            options,
            table,
            row,
            {},
            derived,
            source.table.height - table.height,
            tuple(notes),
        )
    wide = wide_groups(table.columns) if not prepared.choices else {}
    joints = tuple(joints_of(prepared)) or tuple(next(iter(wide.values()), {}))
    used = {choice.source: channel for channel, choice in prepared.choices.items()}
    columns = tuple(
        _file_column(table[name], name in prepared.derived, used.get(name))
        for name in table.columns
    )
    channels: dict[str, Column] = {}
    slides = options.joint_kind == "prismatic" or any(
        choice.unit is not None and choice.unit.dimension.startswith(("length", "linear", "force"))
        for choice in prepared.choices.values()
    )
    for channel, choice in prepared.choices.items():
        if channel in ("joint", "run"):
            continue
        try:
            values, unit_named, _ = channel_values(prepared, channel, np.arange(table.height))
        except RecordingError as error:
            problem = problem or str(error)
            continue
        finite = values[np.isfinite(values)]
        dimensions = CHANNELS[channel]
        # Angle and torque stand first in the list of a channel, length and force second.
        si = unit_named or SI[dimensions[1 if slides and len(dimensions) > 1 else 0]]
        if finite.size:
            channels[channel] = make_column(
                channel, choice.source, si, choice.source in prepared.derived, finite
            )
    runs, rate, gaps = _pace(prepared)
    return Table(
        source.path, source.sha256, table.height, joints, bool(wide), runs, columns, channels, rate,
        gaps, problem, prepared.notes,
    )  # fmt: skip


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
    """Count runs and gaps and find the rate over every joint of a file."""
    choices = prepared.choices
    if "time" not in choices:
        return 1, None, None
    try:
        time = column_numbers(prepared.source, prepared.table, prepared.row, choices["time"].source)
    except RecordingError:
        return 1, None, None
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
