"""From the columns of one joint to a complete, checked `Recording`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.base.errors import RecordingError, option
from stribeck.base.units import SI
from stribeck.recording.arrays import Ints, bools
from stribeck.recording.assembly.averaged import averaged
from stribeck.recording.assembly.sampled import sampled
from stribeck.recording.blocks.hold_out import with_hold_out
from stribeck.recording.blocks.repeated_motion import held_out_together
from stribeck.recording.blocks.speeds_once import held_out_in_turn
from stribeck.recording.consistency.run import checked
from stribeck.recording.joint.channels import Channels, Layout, wanted_channels
from stribeck.recording.joint.drive import with_drive
from stribeck.recording.joint.motor_side import check_motor, load_motor, with_motor
from stribeck.recording.joint.reference import check_reference, load_reference, with_reference
from stribeck.recording.joint.required import require
from stribeck.recording.joint.samples import check_size, check_time, drop_missing, in_runs
from stribeck.recording.joint.units import natural_unit, settle_units
from stribeck.recording.joint.unused import unused_numbers
from stribeck.recording.mend.rows import drop_bad_rows
from stribeck.recording.mend.stamps import drop_repeated_stamps
from stribeck.recording.mend.wraps import unwrap
from stribeck.recording.naming.names import CHANNELS, unknown_unit
from stribeck.recording.naming.proposals import propose
from stribeck.recording.recording import Column, Recording
from stribeck.recording.stated.origin import Origin
from stribeck.recording.tables.prepared import Prepared, columns_of
from stribeck.recording.torque_at import guess_torque_at
from stribeck.recording.weights import check_scored_weights

__all__ = [
    "build",
    "completed",
    "load_channels",
    "nothing_moves",
    "settled",
    "torque_place",
]

#: Optional channels without which much is lost: a column that may hold one is named.
WORTH_A_NOTE = ("velocity", "temperature")


def build(
    prepared: Prepared,
    joint: str | None,
    rows: Ints,
    *,
    standstill: bool = False,
    mend: bool = True,
) -> Recording:
    """Build the recording of one joint.

    Parameters
    ----------
    rows
        Rows of the table that belong to the joint, [n].
    standstill
        Accept a recording in which nothing moves.
    mend
        Whether bad rows are left out and positions unwrapped; parts of a data set are not mended.

    Raises
    ------
    RecordingError
        The table lacks a channel, or its data or units cannot be used.
    """
    data, layout = load_channels(prepared, joint, rows, mend=mend)
    made = completed(data, layout, torque_at=torque_place(prepared))
    made = replace(made, checks=(*data.doubts, *checked(made, prepared, data.rows)))
    made = settled(made, data, standstill=standstill)
    if prepared.settings.hold_out is None:
        return held_out_together(held_out_in_turn(made))
    return with_hold_out(made, prepared, data.rows, prepared.settings.hold_out, layout)


def load_channels(
    prepared: Prepared, joint: str | None, rows: Ints, *, mend: bool = True, one_run: bool = False
) -> tuple[Channels, Layout]:
    """The channels of one joint in SI units, mended, and their layout; see `build`.

    Parameters
    ----------
    one_run
        Whether a table without a run column may be averaged: it is one run.
    """
    require(prepared)
    data, run, run_names, dropped = _loaded(prepared, rows, mend=mend, one_run=one_run)
    kind, torque_unit, position_unit = settle_units(data)
    data.notes.extend(unused_numbers(data, kind))
    _say_assumed(data, kind)
    _say_proposed(data)
    layout = Layout(joint, kind, torque_unit, position_unit, run, run_names, dropped)
    _describe(data, layout)
    if prepared.rows_removed:
        count = prepared.rows_removed
        samples = "1 sample" if count == 1 else f"{count} samples"
        data.notes.append(f"{samples} removed by where: {prepared.settings.where}")
    return data, layout


def completed(data: Channels, layout: Layout, *, torque_at: str | None) -> Recording:
    """The recording of loaded channels, not yet checked; `settled` comes next."""
    settings = data.prepared.settings
    files = ((data.path, data.prepared.source.sha256),)
    origin = Origin(settings, tuple(data.values), tuple(data.notes), files)
    made = averaged(data, layout) if settings.average else sampled(data, layout)
    made = with_motor(with_reference(made, data), data)
    made = replace(made, torque_at=torque_at, origin=origin)
    if settings.rows == "all":
        made = _all_scored(made)
    return replace(made, trusted=settings.trust)


def settled(made: Recording, data: Channels, *, standstill: bool) -> Recording:
    """A checked recording with its drive, refused where nothing moves."""
    if not (made.averaged or standstill or made.moving.any()):
        raise nothing_moves(made)
    if made.weight is not None:
        check_scored_weights(made)
    return with_drive(made, data.prepared, data.values)


def _loaded(
    prepared: Prepared, rows: Ints, *, mend: bool, one_run: bool
) -> tuple[Channels, Ints, tuple[str, ...], int]:
    """The channels in order, mended; the run of each sample, their names, and how many lacked one.

    Raises
    ------
    RecordingError
        Values are missing, or time does not increase.
    """
    data = Channels(prepared, rows)
    for channel in wanted_channels(prepared):
        data.load(channel)
    if prepared.weight is not None:
        data.values["weight"] = prepared.weight[rows]
    data.drop_empty()
    load_reference(data, prepared)
    load_motor(data, prepared)
    check_size(data)
    dropped = drop_missing(data)
    check_reference(data)
    check_motor(data)
    run_names, run = in_runs(data, one_run=one_run)
    # Samples of a run together, in the order of the file.
    order = np.argsort(run, kind="stable")
    if not np.array_equal(order, np.arange(len(order))):
        data.reorder(order)
        run = run[order]
    if mend:
        run = drop_repeated_stamps(data, run)
    check_time(data, run)
    if mend:
        run = drop_bad_rows(data, run)
    unwrap(data, run, mend=mend)
    return data, run, run_names, dropped


def _describe(data: Channels, layout: Layout) -> None:
    """State source, unit and range of every channel that was read."""
    units = {
        "time": "s",
        "position": layout.position_unit,
        "velocity": f"{layout.position_unit}/s",
        "acceleration": f"{layout.position_unit}/s2",
        "temperature": "degC",
        "reference_position": layout.position_unit,
        "reference_velocity": f"{layout.position_unit}/s",
        "reference_acceleration": f"{layout.position_unit}/s2",
        "motor_position": data.units.get("motor_position") or layout.position_unit,
        "motor_velocity": data.units.get("motor_velocity") or f"{layout.position_unit}/s",
        "current": "A",
        "enabled": "1",
    }
    if data.prepared.settings.drive is not None:
        natural = natural_unit(layout.joint_kind)
        units.update({"load_torque": natural, "external_torque": natural})
    for channel, values in data.values.items():
        if channel == "weight":
            formula = str(data.prepared.settings.weights)
            data.columns[channel] = Column.of(channel, formula, "1", True, values)
            continue
        source = data.prepared.choices[channel].source
        unit = units.get(channel, layout.torque_unit)
        derived = source in data.prepared.derived
        data.columns[channel] = Column.of(channel, source, unit, derived, values)


def _say_assumed(data: Channels, kind: str) -> None:
    """Note the columns that are read in SI units because nothing names theirs."""
    assumed = []
    for channel in data.values:
        choice, dimensions = data.prepared.choices.get(channel), CHANNELS.get(channel, ())
        if choice is None or not dimensions or choice.unit is not None:
            continue
        if choice.channel != channel:
            continue
        slides = kind == "prismatic" and len(dimensions) > 1
        read_in = SI[dimensions[slides]]
        assumed.append(f"{choice.source} in {read_in}")
        if (unknown := unknown_unit(choice.source)) is not None:
            data.notes.append(
                f"'{unknown}' in the name '{choice.source}' is no unit that stribeck knows: the "
                f"column is read in {read_in}; if that is wrong, give another unit with "
                f"{option('unit', f'{choice.source}=UNIT')}, or convert it with "
                f"{option('derive', f'{channel}=FORMULA')}"
            )
    if assumed:
        data.notes.append(f"units assumed: {', '.join(assumed)}")


def _say_proposed(data: Channels) -> None:
    """Note the columns that may hold an optional channel which was not found."""
    names = data.prepared.table.columns
    used = {choice.source for choice in data.prepared.choices.values()}
    decided = {*data.prepared.choices, *data.prepared.settings.maps}
    for row in propose(names, used, data.prepared.settings.joint):
        if row.channel in WORTH_A_NOTE and row.channel not in decided:
            data.notes.append(
                f"'{row.column}' is not read: if it is the {row.channel} of the joint, give "
                f"{option('map', f'{row.channel}={row.column}')}"
            )


def torque_place(prepared: Prepared) -> str | None:
    """Where the torque was measured, as given or by its name."""
    given = prepared.settings.torque_at
    if given is not None or "friction_torque" in prepared.choices:
        return given
    choice = prepared.choices.get("torque") or prepared.choices.get("current")
    if choice is None:
        return None
    channel = "torque" if "torque" in prepared.choices else "current"
    is_current = choice.channel == "current"
    return guess_torque_at(columns_of(prepared, channel), is_current=is_current)


def _all_scored(recording: Recording) -> Recording:
    """The recording with every sample scored."""
    return replace(
        recording,
        moving=bools(np.ones(len(recording.time))),
        velocity_threshold=0.0,
        notes=(*recording.notes, "every sample is scored, moving or not, as given"),
    )


def nothing_moves(recording: Recording) -> RecordingError:
    """The refusal of a recording without a moving sample."""
    wrong = next((c for c in recording.checks if c.check == "velocity" and not c.ok), None)
    if wrong is not None:
        return RecordingError(f"{recording.path}: {wrong.said}: {wrong.do}")
    what = (
        "the velocity is zero throughout"
        if not recording.velocity.any()
        else f"no sample is faster than its own noise ({recording.velocity_threshold:.3g} "
        f"{recording.position_unit}/s)"
    )
    return RecordingError(
        f"{recording.path}: nothing moves, {what}: give a recording with motion, or state with "
        f"{option('moving_above', 'V')} from which speed on samples move"
    )
