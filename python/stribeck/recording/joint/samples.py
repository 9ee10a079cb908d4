"""The samples of one joint: their runs, missing values and the order of time."""

from __future__ import annotations

import numpy as np
import polars as pl

from stribeck.base.checks import LARGEST
from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Ints
from stribeck.recording.joint.channels import Channels
from stribeck.recording.naming.names import BESIDE
from stribeck.recording.tables.cells import labels, numbered

__all__ = ["check_size", "check_time", "drop_missing", "in_runs"]

#: From this share of samples with missing values on, a recording is refused.
_MISSING_SHARE = 0.05


def in_runs(data: Channels, *, one_run: bool = False) -> tuple[tuple[str, ...], Ints]:
    """Names of the runs, and the number of the run of each sample, [n].

    Parameters
    ----------
    one_run
        Whether the samples may be averaged without a column of runs: they are one.

    Raises
    ------
    RecordingError
        Runs are to be averaged and no column names them.
    """
    if data.prepared.settings.average == "row":
        return tuple(map(str, range(1, len(data.rows) + 1))), np.arange(len(data.rows))
    choice = data.prepared.choices.get("run")
    if choice is None:
        if data.prepared.settings.average and not one_run:
            raise RecordingError(
                f"{data.path}: {option('average', 'run')} needs a run column: name it with "
                f"{option('map', 'run=COLUMN')}"
            )
        return ("",), np.zeros(len(data.rows), dtype=np.int64)
    names, number = numbered(labels(data.prepared.table[data.rows], choice.source))
    return tuple(names), number


def check_size(data: Channels) -> None:
    """Refuse channels with numbers that no measurement has: their squares are not finite, or zero.

    Raises
    ------
    RecordingError
        A number is too large, or all of them are too small.
    """
    for channel, values in data.values.items():
        sizes = np.where(np.isfinite(values), np.abs(values), 0.0)
        at = int(np.argmax(sizes)) if sizes.size else 0
        largest = float(sizes[at]) if sizes.size else 0.0
        is_small = 0.0 < largest < 1.0 / LARGEST and channel not in ("weight", "time")
        if largest <= LARGEST and not is_small:
            continue
        choice = data.prepared.choices.get(channel)
        column = channel if choice is None else choice.source
        what = (
            f"column '{column}' is nowhere larger than {largest:.3g}"
            if is_small
            else f"{data.place(at)}, column '{column}': {largest:.3g} is beyond {LARGEST:g}"
        )
        raise RecordingError(
            f"{data.path}: {what}: correct the file, or give its unit with "
            f"{option('unit', f'{channel}=UNIT')}"
        )


def drop_missing(data: Channels) -> int:
    """Drop samples with an empty, NaN or infinite cell; returns how many.

    Cells of the reference trajectory and of the motor's encoder do not count: few analyses read
    them.

    Raises
    ------
    RecordingError
        They are more than a few.
    """
    bad = np.zeros(len(data.rows), dtype=bool)
    worst, most = "", 0
    for channel, values in data.values.items():
        if channel in BESIDE:
            continue
        missing = ~np.isfinite(values)
        count = int(missing.sum())
        if count > most:
            worst, most = channel, count
        bad |= missing
    total = int(bad.sum())
    if not total:
        return 0
    source = data.prepared.choices[worst].source
    place = data.place(int(np.flatnonzero(~np.isfinite(data.values[worst]))[0]))
    if total >= _MISSING_SHARE * len(bad):
        optional = worst in ("temperature", "load_torque", "acceleration")
        advice = (
            f"leave the column out with {option('map', f'{worst}=none')}"
            if optional
            else f"correct the file or use {option('where')}"
        )
        raise RecordingError(
            f"{data.path}: {total} of {len(bad)} rows have empty, NaN or infinite cells, {most} "
            f"of them in column '{source}', first in {place}: {advice}"
        )
    data.notes.append(
        f"{total} of {len(bad)} rows with empty, NaN or infinite cells are left out "
        f"(first in {place}, column '{source}')"
    )
    data.join(~bad)
    return total


def check_time(data: Channels, run: Ints) -> None:
    """Refuse time that is repeated or runs backwards within a run.

    Raises
    ------
    RecordingError
    """
    n = len(data.rows)
    if n < 2:
        raise RecordingError(f"{data.path}: {n} sample is not a recording, give at least two")
    if "time" not in data.values or data.prepared.settings.average:
        return
    time = data.values["time"]
    wrong = np.flatnonzero((np.diff(time) <= 0.0) & (run[1:] == run[:-1]))
    if not wrong.size:
        return
    at = int(wrong[0]) + 1
    column = data.prepared.choices["time"].source
    before, now = time[at - 1], time[at]
    what = (
        f"is repeated ({now:.9g} s)"
        if now == before
        else f"runs backwards from {before:.9g} to {now:.9g} s"
    )
    if "run" in data.prepared.choices:
        inside = f" inside run '{in_runs(data)[0][int(run[at])]}'"
        advice = f"correct the file, or name the run column with {option('map', 'run=COLUMN')}"
    else:
        inside = ""
        guess = _run_columns(data, at)
        named = option("map", f"run={guess[0]}" if guess else "run=COLUMN")
        advice = (
            f"if the file holds several runs, name the run column with {named}; otherwise remove "
            "that row"
        )
    raise RecordingError(
        f"{data.path}: {data.place(at)}, column '{column}': time {what}{inside}: {advice}"
    )


def _run_columns(data: Channels, at: int) -> list[str]:
    """Columns of names or whole numbers whose value changes exactly where time starts again."""
    table = data.prepared.table
    pair = table[data.rows[at - 1 : at + 1]]
    return [
        name
        for name in table.columns
        if (table.schema[name].is_integer() or table.schema[name] == pl.String)
        and pair[name][0] != pair[name][1]
        and table[name].n_unique() < max(3, table.height // 10)
    ]
