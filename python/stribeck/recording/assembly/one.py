"""One joint of one file as a recording."""

from __future__ import annotations

from dataclasses import replace

from stribeck.base.errors import RecordingError, listed, nearest
from stribeck.recording.arrays import Ints
from stribeck.recording.assembly.assemble import build
from stribeck.recording.recording import Recording
from stribeck.recording.stated.options import FilePath, ReadOptions
from stribeck.recording.stated.settings import gather
from stribeck.recording.tables.cells import labels
from stribeck.recording.tables.prepared import Prepared, joint_rows
from stribeck.recording.tables.readers import Source
from stribeck.recording.whole_file.table import prepare, prepared_table

__all__ = ["of_joint", "one_joint", "read_one"]


def read_one(given: FilePath | Source, options: ReadOptions) -> Recording:
    """Read one joint of one file or table; see `stribeck.read`."""
    return build(*one_joint(given, options), standstill=options.standstill)


def one_joint(given: FilePath | Source, options: ReadOptions) -> tuple[Prepared, str | None, Ints]:
    """The table of a file or in memory, the joint to read, and its rows."""
    settings = gather(given.path if isinstance(given, Source) else given, options)
    if isinstance(given, Source):
        prepared = prepared_table(given, settings)
    else:
        prepared = prepare(str(given), settings)
    name, own = joint_rows(prepared, settings.joint)
    return of_joint(prepared, name), name, own


def of_joint(prepared: Prepared, joint: str | None) -> Prepared:
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
                    f"{nearest(name, there) or '; it has ' + listed(there)}"
                )
    # A current becomes a torque joint by joint, so each joint has its own choice of columns.
    return replace(prepared, settings=settings.for_joint(joint), choices=dict(prepared.choices))
