"""`read` and `read_all`: from a path and options to recordings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.assemble import build
from stribeck.recording.options import Pairs, gather
from stribeck.recording.recording import Recording
from stribeck.recording.table import Prepared, joint_rows, joints_of, labels, prepare

__all__ = ["read", "read_all"]


def read(
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
    standstill: bool = False,
) -> Recording:
    """Read one joint of a recording.

    Parameters
    ----------
    path
        CSV, TSV, Parquet, Arrow, .npz or .mat file.
    sidecar
        Sidecar to use instead of ``FILE.EXT.sidecar.toml`` beside the file. Options win over it.
    joint
        Joint of a file that holds several.
    joint_kind
        ``"revolute"`` or ``"prismatic"``.
    gear_ratio, torque_constant
        Joint-side torque = current [A] * torque_constant [N m/A] * gear_ratio.
    inertia
        Known inertia [kg m2] or mass [kg]: load torque = inertia * acceleration (+ gravity).
    km, kb, kt
        Motor constant [N m/W^0.5], back-EMF constant [V s/rad] and torque constant [N m/A] for the
        electrical energy; a voltage drive takes kt, and the resistance from km, as known.
    unit
        ``"COLUMN=UNIT"`` texts: the unit of a column of the file.
    map
        ``"NAME=COLUMN"`` texts: which column of the file a channel is; ``NAME=none`` leaves it out.
    derive
        ``"NAME=FORMULA"`` texts: new columns from those of the file, in the file's own units.
    where
        Condition on the columns; rows that fail it become gaps.
    average
        ``"run"``: one row per run, the median of each channel. ``"row"``: each row of the file is a
        steady-state point by itself, a friction map; it needs no time.
    drive
        ``"voltage"``: the effort is the mean voltage on a DC motor. The load torque must then be
        known, by rigid-body terms or a column; a column `enabled` says where the motor is on.
    hold_out
        ``"COLUMN"``: held-out blocks are the rows that share a value of this column of the file,
        whichever runs they are in; ``"COLUMN=VALUE"``: of them, this one alone counts.
    rows
        ``"moving"``: rows at rest do not count, since what holds a joint at rest is not its
        friction in motion. ``"all"``: every row counts, for points of which none is at rest.
    standstill
        Take a recording in which no row is faster than its velocity noise: presliding, or passes
        so slow that only a line through many samples shows them.

    Raises
    ------
    RecordingError
        One sentence that says what is wrong, where, and what to do.
    """
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, km=km, kb=kb, kt=kt, unit=unit, map=map,
        derive=derive, where=where, average=average, drive=drive, hold_out=hold_out,
        rows=rows,
    )  # fmt: skip
    prepared = prepare(str(path), options)
    name, own = joint_rows(prepared, options.joint)
    return build(_of_joint(prepared, name), name, own, standstill=standstill)


def read_all(
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
) -> list[Recording]:
    """Read every joint of a recording, in order of appearance; see `read`."""
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, km=km, kb=kb, kt=kt, unit=unit, map=map,
        derive=derive, where=where, average=average, drive=drive, hold_out=hold_out,
        rows=rows,
    )  # fmt: skip
    prepared = prepare(str(path), options)
    wanted: Iterable[str | None] = joints_of(prepared) or [None]
    if options.joint is not None:
        wanted = [options.joint]
    return [build(_of_joint(prepared, name), *joint_rows(prepared, name)) for name in wanted]


def _of_joint(prepared: Prepared, joint: str | None) -> Prepared:
    """The table with what was said about one joint.

    Raises
    ------
    RecordingError
        When the sidecar speaks of a joint that the file does not have.
    """
    options, choice = prepared.options, prepared.choices.get("joint")
    whole = prepared.source.table
    if options.joints and choice is not None and choice.source in whole.columns:
        # Of the whole file: --where may have left some joints out.
        there = labels(whole, choice.source).unique(maintain_order=True).to_list()
        for name in options.joints:
            if name not in there:
                raise RecordingError(
                    f"{options.sidecar}: [joints.{name}]: {prepared.source.path} has no such joint"
                    f"{nearest(name, there) or '; it has ' + ', '.join(there)}"
                )
    # A current becomes a torque joint by joint, so each has its own choice of columns.
    return replace(prepared, options=options.for_joint(joint), choices=dict(prepared.choices))
