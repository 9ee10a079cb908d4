"""Several files as the runs of one recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import polars as pl

from stribeck.base.errors import RecordingError, nearest, option
from stribeck.recording.arrays import Ints
from stribeck.recording.assembly.assemble import completed, load_channels, torque_place
from stribeck.recording.assembly.one import one_joint
from stribeck.recording.consistency.run import checked
from stribeck.recording.recording import Recording
from stribeck.recording.several.join import join
from stribeck.recording.several.part import Part
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.tables.cells import labels
from stribeck.recording.tables.prepared import Prepared
from stribeck.recording.tables.readers import Source

__all__ = ["read_several"]

#: Samples of all files together that are read into memory at most.
_MOST = 50_000_000
_PARQUET = (".parquet", ".pq")
#: What can be held out by although no file has such a column.
_OWN = ("file", "run")


def read_several(
    given: Sequence[str | Source], names: Sequence[str], options: ReadOptions, path: str
) -> Recording:
    """One recording of several files or tables, in this order; each is a run, or several.

    Parameters
    ----------
    names
        Of the run of each.
    path
        As sentences name the recording.

    Raises
    ------
    RecordingError
        A file cannot be used, or the files are not of one joint.
    """
    _refuse_too_many([one for one in given if isinstance(one, str)], path)
    parts = [_part(one, name, options) for one, name in zip(given, names, strict=True)]
    return join(parts, path, standstill=options.standstill)


def _refuse_too_many(files: Sequence[str], path: str) -> None:
    if not all(file.lower().endswith(_PARQUET) for file in files):
        return
    try:
        rows = sum(int(pl.scan_parquet(f).select(pl.len()).collect().item()) for f in files)
    except (pl.exceptions.PolarsError, OSError):
        # A damaged file is refused when it is read.
        return
    if rows > _MOST:
        raise RecordingError(
            f"{path}: {len(files)} files hold {rows:.3g} samples, at most {_MOST:.3g} are read "
            f"into memory: read them in passes, with {option('stream')} (in Python `sb.stream`)"
        )


def _part(file: str | Source, name: str, options: ReadOptions) -> Part:
    """What is read of one file or table."""
    prepared, joint, rows = one_joint(file, options)
    data, layout = load_channels(prepared, joint, rows, one_run=True)
    torque_at = torque_place(prepared)
    part = Part.of_channels(data, layout, name, torque_at)
    part = replace(part, labels=_labels(prepared, part, data.rows))
    of_file = data.rows
    if prepared.settings.average == "run":
        # One run alone is a single point: it is checked with the others.
        return replace(part, checker=lambda made: checked(made, prepared, of_file))
    alone = completed(data, layout, torque_at=torque_at)
    return replace(part, checks=(*data.doubts, *checked(alone, prepared, of_file)))


def _labels(prepared: Prepared, part: Part, rows: Ints) -> pl.Series | None:
    """What the samples are held out by; None where no column of the file is named."""
    given = prepared.settings.hold_out
    if given is None:
        return None
    column = given.partition("=")[0].strip()
    if column in prepared.table.columns:
        return labels(prepared.table[rows], column)
    if column in _OWN:
        return None
    hint = nearest(column, prepared.table.columns)
    raise RecordingError(
        f"{part.path}: {option('hold_out', given)}: there is no column '{column}'"
        f"{hint or '; the file has ' + ', '.join(prepared.table.columns)}"
    )
