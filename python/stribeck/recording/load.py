"""`read` and `read_all`: from files and options to recordings."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.recording.assemble import build
from stribeck.recording.one import of_joint, read_one
from stribeck.recording.options import ReadArguments, ReadOptions
from stribeck.recording.recording import Recording
from stribeck.recording.settings import gather
from stribeck.recording.several.paths import Given, listed_files, text_of
from stribeck.recording.several.read import read_several
from stribeck.recording.table import joint_rows, joints_of, prepare

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Given", "read", "read_all", "read_with"]


def read(path: Given, **options: Unpack[ReadArguments]) -> Recording:
    """Read one joint of a recording.

    Parameters
    ----------
    path
        CSV, TSV, Parquet, Arrow, .npz or .mat file. Several, a folder or a pattern such as
        ``"run*.csv"`` are runs of one joint, named by their files; each has its own sidecar.
    sidecar
        Sidecar to use instead of ``FILE.EXT.sidecar.toml`` beside the file. An option wins over it.
    joint, joint_kind
        Joint of a file that holds several; ``"revolute"`` or ``"prismatic"``.
    gear_ratio, torque_constant
        Joint-side torque = current [A] * torque_constant [N m/A] * gear_ratio.
    inertia
        Known inertia [kg m2] or mass [kg]: load torque = inertia * acceleration (+ gravity).
    km, kb, kt
        Motor constant [N m/W^0.5], back-EMF constant [V s/rad] and torque constant [N m/A] for the
        electrical energy. A voltage drive takes kt as known, and the resistance from km.
    unit
        ``"COLUMN=UNIT"`` texts: the unit of a column of the file.
    map
        ``"NAME=COLUMN"`` texts: which column of the file a channel is; ``NAME=none`` leaves it out.
    derive
        ``"NAME=FORMULA"`` texts: new columns from those of the file, in the file's own units.
    where
        Condition on the columns; rows for which it does not hold become gaps.
    average
        ``"run"``: one point per run, the median of each channel. ``"row"``: each row of the file is
        a steady-state point, as in a friction map; it needs no time.
    drive
        ``"voltage"``: the effort is the mean voltage on a DC motor. The load torque must then be
        known, from rigid-body terms or a column; a column `enabled` says where the motor is on.
    hold_out
        ``"COLUMN"``: each held-out block has one value of this column of the file, whichever runs
        it is in. ``"COLUMN=VALUE"``: the held-out error is that of this block alone.
    weights
        ``"COLUMN"`` or a formula of columns of the file: the weight of each sample's squared error
        in a fit, ``"1/sigma^2"`` for a column of standard deviations. Only ratios of weights
        matter.
    rows, moving_above
        ``"moving"``: samples at rest are not scored, since the torque that holds a joint at rest
        is not its friction in motion; those move that are faster than `moving_above` [rad/s or
        m/s], by default than five times the noise of the velocity. ``"all"``: all are scored.
    torque_at
        Where the torque was measured: ``"motor"``, ``"command"`` or ``"link"``.
    unwrap, trust
        Unwrap a position even if it is not certain that it wraps; fit channels that contradict
        each other (`Recording.checks`).
    standstill
        Accept a recording in which no sample moves: presliding, or very slow motion.

    Raises
    ------
    RecordingError
        One sentence that says what is wrong, where, and what to do.
    """
    return read_with(path, ReadOptions(**options))


def read_with(path: Given, options: ReadOptions) -> Recording:
    """Read one joint of a recording; see `read`."""
    files = listed_files(path)
    if len(files) == 1:
        return read_one(files[0], options)
    return read_several(files, options, text_of(path, files))


def read_all(path: str | Path, **options: Unpack[ReadArguments]) -> list[Recording]:
    """Read every joint of a recording, in order of appearance; see `read`."""
    given = ReadOptions(**options)
    settings = gather(path, given)
    prepared = prepare(str(path), settings)
    wanted: Iterable[str | None] = joints_of(prepared) or [None]
    if settings.joint is not None:
        wanted = [settings.joint]
    return [
        build(of_joint(prepared, name), *joint_rows(prepared, name), standstill=given.standstill)
        for name in wanted
    ]
