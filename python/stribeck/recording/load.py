"""`read` and `read_all`: from files and options to recordings."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from stribeck.base.arguments import door
from stribeck.base.errors import RecordingError
from stribeck.recording.assembly.assemble import build
from stribeck.recording.assembly.one import of_joint, read_one
from stribeck.recording.recording import Recording
from stribeck.recording.several.paths import Given, listed_files, run_names, text_of
from stribeck.recording.several.read import read_several
from stribeck.recording.stated.options import ReadArguments, ReadOptions
from stribeck.recording.stated.settings import gather
from stribeck.recording.tables.in_memory import is_table, table_source
from stribeck.recording.tables.readers import Source
from stribeck.recording.whole_file.table import joint_rows, joints_of, prepare

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: Tables in memory: one, or several.
Tables: TypeAlias = Any

__all__ = ["Given", "read", "read_all", "read_with"]


@door(RecordingError, path=("a path, several, or a pattern", object))
def read(path: Given | Tables, **options: Unpack[ReadArguments]) -> Recording:
    """Read one joint of a recording.

    Parameters
    ----------
    path
        A file, or a table in memory: a polars or pandas frame, a pyarrow table, a mapping from
        names to arrays [n]. Several, a folder or a pattern (``"run*.csv"``) are runs of one joint.

    Other Parameters
    ----------------
    sidecar
        Sidecar to use instead of ``FILE.EXT.sidecar.toml`` beside the file. An option wins over it.
    columns, memory_limit
        Names for the columns of a table without a header (``"t,q,dq,tau"``); largest table [GB].
    joint, joint_kind
        Joint of a file that holds several; ``"revolute"`` or ``"prismatic"``.
    gear_ratio, torque_constant, screw_pitch
        Torque = current [A] * torque_constant [N m/A] * gear_ratio; force = torque * 2 pi / pitch.
    inertia
        Known inertia [kg m2] or mass [kg]: load torque = inertia * acceleration (+ gravity).
    km, kb, kt
        Motor constant [N m/W^0.5], back-EMF constant [V s/rad] and torque constant [N m/A].
    unit, map
        ``"COLUMN=UNIT"`` texts: the unit of a column of the file; ``"NAME=COLUMN"`` texts: which
        column of the file a channel is, where ``NAME=none`` leaves it out.
    derive, where
        ``"NAME=FORMULA"`` texts: new columns from those of the file, in the file's own units; a
        condition on the columns: rows for which it does not hold become gaps.
    average
        ``"run"``: one point per run, its medians. ``"row"``: each row is a point; no time needed.
    drive
        ``"voltage"``: that on a DC motor is the effort; a column `enabled` says where it is on.
    hold_out
        ``"COLUMN"``: each held-out block has one value of this column of the file.
        ``"COLUMN=VALUE"``: the held-out error is that of this block alone.
    weights
        A column or formula: the weight of each sample's squared error in a fit (``"1/sigma^2"``).
    rows, moving_above
        ``"moving"``: samples at rest are not scored. Those move that are faster than `moving_above`
        [rad/s or m/s], by default than five times the noise of the velocity. ``"all"``: all are.
    torque_at
        Where the torque was measured: ``"motor"``, ``"command"`` or ``"link"``.
    unwrap, trust, standstill
        Unwrap a position that may wrap; fit channels that contradict each other; accept a recording
        in which no sample moves: presliding, or very slow motion.

    Raises
    ------
    RecordingError
        What is wrong, where, and what to do.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(500) / 100.0
    >>> sb.read({"t": t, "qd_rpm": np.sin(t), "tau": np.sign(np.sin(t))}).columns["velocity"].unit
    'rad/s'
    """
    return read_with(path, ReadOptions.of(options))


def read_with(path: Given | Tables, options: ReadOptions) -> Recording:
    """Read one joint of a recording; see `read`."""
    given: list[Any] = _listed(path)
    tables = [table_source(one) if is_table(one) else None for one in given]
    if any(tables):
        return _with_tables(given, tables, options)
    files = listed_files(path)
    if len(files) == 1:
        return read_one(files[0], options)
    return read_several(files, run_names(files), options, text_of(path, files))


def _with_tables(
    given: Sequence[Any], tables: Sequence[Source | None], options: ReadOptions
) -> Recording:
    """Tables in memory, and perhaps files among them; their runs are numbered."""
    listed: list[str | Source] = []
    for one, table in zip(given, tables, strict=True):
        listed += listed_files(one) if table is None else [table]
    if len(listed) == 1:
        return read_one(listed[0], options)
    names = [str(k) for k in range(1, len(listed) + 1)]
    return read_several(listed, names, options, f"{len(listed)} tables")


def _listed(given: Any) -> list[Any]:
    """What is given, as a list of files and tables."""
    is_list = isinstance(given, Iterable) and not (isinstance(given, str) or is_table(given))
    listed = list(given) if is_list else [given]
    for one in listed:
        if not (isinstance(one, str | os.PathLike) or is_table(one)):
            raise RecordingError(
                f"{type(one).__name__} {one!r:.40} cannot be read: give a file, a folder, a "
                "pattern, a table (polars, pandas, pyarrow, or arrays by name), or a list of them"
            )
    return listed


def read_all(path: str | Path, **options: Unpack[ReadArguments]) -> list[Recording]:
    """Read every joint of a recording, in order of appearance; see `read`."""
    given = ReadOptions.of(options)
    settings = gather(path, given)
    prepared = prepare(str(path), settings)
    wanted: Iterable[str | None] = joints_of(prepared) or [None]
    if settings.joint is not None:
        wanted = [settings.joint]
    return [
        build(of_joint(prepared, name), *joint_rows(prepared, name), standstill=given.standstill)
        for name in wanted
    ]
