"""From the columns of one joint to a complete, checked `Recording`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Ints, bools
from stribeck.recording.averaged import averaged
from stribeck.recording.channels import Channels, Layout, require, wanted_channels
from stribeck.recording.drive import with_drive
from stribeck.recording.hold_out import with_hold_out
from stribeck.recording.joint_units import natural_unit, settle_units
from stribeck.recording.recording import Column, Recording
from stribeck.recording.sampled import sampled
from stribeck.recording.samples import check_time, drop_missing, in_runs
from stribeck.recording.table import Prepared

__all__ = ["build"]


def build(
    prepared: Prepared, joint: str | None, rows: Ints, *, standstill: bool = False
) -> Recording:
    """Build the recording of one joint.

    Parameters
    ----------
    rows
        Rows of the table that belong to the joint, [n].
    standstill
        Accept a recording in which nothing moves.

    Raises
    ------
    RecordingError
        The table lacks a channel, or its data or units cannot be used.
    """
    require(prepared)
    settings = prepared.settings
    data = Channels(prepared, rows)
    for channel in wanted_channels(prepared):
        data.load(channel)
    data.drop_empty()
    dropped = drop_missing(data)
    run_names, run = in_runs(data)
    # Samples of a run together, in the order of the file.
    order = np.argsort(run, kind="stable")
    if not np.array_equal(order, np.arange(len(order))):
        data.reorder(order)
        run = run[order]
    check_time(data, run)
    kind, torque_unit, position_unit = settle_units(data)
    layout = Layout(joint, kind, torque_unit, position_unit, run, run_names, dropped)
    _describe(data, layout)
    if prepared.rows_removed:
        count = prepared.rows_removed
        samples = "1 sample" if count == 1 else f"{count} samples"
        data.notes.append(f"{samples} removed by where: {settings.where}")
    made = averaged(data, layout) if settings.average else sampled(data, layout)
    if settings.rows == "all":
        made = _all_scored(made)
    if not (settings.average or standstill or made.moving.any()):
        raise _nothing_moves(made)
    made = with_drive(made, prepared, data.values)
    if settings.average or settings.hold_out is None:
        return made
    return with_hold_out(made, prepared, data.rows, settings.hold_out)


def _describe(data: Channels, layout: Layout) -> None:
    """State source, unit and range of every channel that was read."""
    units = {
        "time": "s",
        "position": layout.position_unit,
        "velocity": f"{layout.position_unit}/s",
        "acceleration": f"{layout.position_unit}/s2",
        "temperature": "degC",
        "current": "A",
        "enabled": "1",
    }
    if data.prepared.settings.drive is not None:
        natural = natural_unit(layout.joint_kind)
        units.update({"load_torque": natural, "external_torque": natural})
    for channel, values in data.values.items():
        source = data.prepared.choices[channel].source
        unit = units.get(channel, layout.torque_unit)
        derived = source in data.prepared.derived
        data.columns[channel] = Column.of(channel, source, unit, derived, values)


def _all_scored(recording: Recording) -> Recording:
    """The recording with every sample scored."""
    return replace(
        recording,
        moving=bools(np.ones(len(recording.time))),
        velocity_threshold=0.0,
        notes=(*recording.notes, "every sample is scored, moving or not, as given"),
    )


def _nothing_moves(recording: Recording) -> RecordingError:
    what = (
        "the velocity is zero throughout"
        if not recording.velocity.any()
        else f"no sample is faster than its own noise ({recording.velocity_threshold:.3g} "
        f"{recording.position_unit}/s)"
    )
    return RecordingError(f"{recording.path}: nothing moves, {what}: give a recording with motion")
