"""`read` and `read_all`: from a path and options to recordings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.assemble import build
from stribeck.recording.cells import labels
from stribeck.recording.options import ReadArguments, ReadOptions
from stribeck.recording.recording import Recording
from stribeck.recording.settings import gather
from stribeck.recording.table import Prepared, joint_rows, joints_of, prepare

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["read", "read_all", "read_with"]


def read(path: str | Path, **options: Unpack[ReadArguments]) -> Recording:
    """Read one joint of a recording.

    Parameters
    ----------
    path
        CSV, TSV, Parquet, Arrow, .npz or .mat file.
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


def read_with(path: str | Path, options: ReadOptions) -> Recording:
    """Read one joint of a recording; see `read`."""
    settings = gather(path, options)
    prepared = prepare(str(path), settings)
    name, own = joint_rows(prepared, settings.joint)
    return build(_of_joint(prepared, name), name, own, standstill=options.standstill)


def read_all(path: str | Path, **options: Unpack[ReadArguments]) -> list[Recording]:
    """Read every joint of a recording, in order of appearance; see `read`."""
    given = ReadOptions(**options)
    settings = gather(path, given)
    prepared = prepare(str(path), settings)
    wanted: Iterable[str | None] = joints_of(prepared) or [None]
    if settings.joint is not None:
        wanted = [settings.joint]
    return [
        build(_of_joint(prepared, name), *joint_rows(prepared, name), standstill=given.standstill)
        for name in wanted
    ]


def _of_joint(prepared: Prepared, joint: str | None) -> Prepared:
    """The table with the settings of one joint.

    Raises
    ------
    RecordingError
        The sidecar names a joint that the file does not have.
    """
    settings, choice = prepared.settings, prepared.choices.get("joint")
    whole = prepared.source.table
    if settings.joints and choice is not None and choice.source in whole.columns:
        # In the whole file: the condition may have removed some joints.
        there = labels(whole, choice.source).unique(maintain_order=True).to_list()
        for name in settings.joints:
            if name not in there:
                raise RecordingError(
                    f"{settings.sidecar}: [joints.{name}]: {prepared.source.path} has no such joint"
                    f"{nearest(name, there) or '; it has ' + ', '.join(there)}"
                )
    # A current becomes a torque joint by joint, so each joint has its own choice of columns.
    return replace(prepared, settings=settings.for_joint(joint), choices=dict(prepared.choices))
