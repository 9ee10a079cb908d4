"""From the columns of one joint to a complete, checked `Recording`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError
from stribeck.recording.derive import Smoother, choose_cutoff, motion_band
from stribeck.recording.drive import natural_unit, with_drive
from stribeck.recording.hold_out import with_hold_out
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import (
    SIGMAS,
    held_out_blocks,
    noise_level,
    quantisation_step,
    segment_rows,
    segment_slices,
)
from stribeck.recording.table import Prepared, channel_values, labels, numbered

__all__ = [
    "BANDS", "Channels", "build", "make_column", "measured_torque", "require", "rigid_body_load",
    "settle_units", "wanted_channels",
]  # fmt: skip

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_MISSING_SHARE = 0.05
#: A derived acceleration reaches up to so many times the band that holds the motion.
BANDS = 20.0


def require(prepared: Prepared) -> None:
    """Refuse a table that lacks what every analysis needs."""
    path = prepared.source.path
    have = prepared.choices
    there = f"the file has {', '.join(prepared.table.columns)}"
    if "time" not in have and not prepared.options.average:
        raise RecordingError(
            f"{path}: there is no time column; {there}: say which with --map time=COLUMN, or, "
            "where each row is a steady-state point by itself, --average row"
        )
    if "velocity" not in have and "position" not in have:
        raise RecordingError(
            f"{path}: there is neither a velocity nor a position column; {there}: say which with "
            "--map velocity=COLUMN or --map position=COLUMN"
        )
    if "torque" not in have and "friction_torque" not in have:
        if "current" in have:
            if prepared.options.knows_torque_constant:
                return
            raise RecordingError(
                f"{path}: there is a current ('{have['current'].source}') but no torque: give "
                "--torque-constant NM_PER_A (and --gear-ratio), or --map torque=COLUMN"
            )
        raise RecordingError(
            f"{path}: there is no torque column; {there}: say which with --map torque=COLUMN, or "
            "make "
            "one with --derive torque=FORMULA"
        )


class Channels:
    """The channels of one joint while they are being checked and completed."""

    def __init__(self, prepared: Prepared, rows: Ints) -> None:
        self.prepared = prepared
        self.path = prepared.source.path
        self.values: dict[str, Floats] = {}
        self.units: dict[str, str] = {}
        self.columns: dict[str, Column] = {}
        self.notes: list[str] = list(prepared.notes)
        self.rows = rows

    def load(self, channel: str) -> None:
        values, unit, _ = channel_values(self.prepared, channel, self.rows)
        self.values[channel] = values
        choice = self.prepared.choices[channel]
        self.units[channel] = unit
        if choice.unit is not None and choice.said_by == "suffix" and choice.unit.name != unit:
            self.notes.append(
                f"{channel} is read from '{choice.source}' in {choice.unit.name}, converted to "
                f"{unit}"
            )
        elif choice.unit is not None and choice.said_by == "option" and choice.unit.name != unit:
            self.notes.append(
                f"'{choice.source}' is in {choice.unit.name} as said, converted to {unit}"
            )

    def keep(self, mask: Bools) -> None:
        self.rows = self.rows[mask]
        self.values = {name: values[mask] for name, values in self.values.items()}


def wanted_channels(prepared: Prepared) -> list[str]:
    """Channels of the table that a recording is made of."""
    have = prepared.choices
    motion = ("time", "position", "velocity", "acceleration", "temperature")
    wanted: list[str] = [c for c in motion if c in have]
    # Friction measured directly stands instead of torque and load; where a file has all three
    # without being told, the torque is what was measured and the friction what someone computed.
    direct = "friction_torque" in have and (
        "friction_torque" in prepared.options.maps
        or not ("torque" in have and "load_torque" in have)
    )
    wanted += [c for c in ("external_torque",) if c in have]
    if prepared.options.drive is not None and "enabled" in have:
        wanted.append("enabled")
    if direct:
        # Friction may depend on the load, so a load that is recorded comes along.
        return [*wanted, "friction_torque", *(c for c in ("load_torque",) if c in have)]
    if "torque" in have:
        wanted.append("torque")
    elif "current" in have:
        wanted.append("current")
    if "load_torque" in have:
        wanted.append("load_torque")
    return wanted


def build(
    prepared: Prepared, joint: str | None, rows: Ints, *, standstill: bool = False
) -> Recording:
    require(prepared)
    options = prepared.options
    path = prepared.source.path
    data = Channels(prepared, rows)
    for channel in wanted_channels(prepared):
        data.load(channel)
    for channel in ("position", "velocity", "acceleration", "temperature", "load_torque"):
        needed = channel == "velocity" and "position" not in data.values
        needed = needed or (channel == "position" and "velocity" not in data.values)
        if channel in data.values and not needed and not np.isfinite(data.values[channel]).any():
            del data.values[channel]
            data.notes.append(
                f"{channel} ('{prepared.choices[channel].source}') is empty and left out"
            )
    if "velocity" not in data.values and "position" not in data.values:
        raise RecordingError(f"{path}: velocity and position hold no numbers")
    run_names, run = _runs(data)
    _drop_missing(data, run)
    dropped = len(rows) - len(data.rows)
    run_names, run = _runs(data)
    # Rows of a run together, in the order of the file.
    order = np.argsort(run, kind="stable")
    if not np.array_equal(order, np.arange(len(order))):
        data.rows = data.rows[order]
        data.values = {name: values[order] for name, values in data.values.items()}
        run = run[order]
    _check_time(data, run)
    kind, torque_unit, position_unit = settle_units(data)
    velocity_unit, acceleration_unit = f"{position_unit}/s", f"{position_unit}/s2"
    units = {
        "time": "s", "position": position_unit, "velocity": velocity_unit,
        "acceleration": acceleration_unit, "temperature": "degC", "current": "A", "enabled": "1",
    }  # fmt: skip
    if options.drive is not None:
        units.update(dict.fromkeys(("load_torque", "external_torque"), natural_unit(kind)))
    for channel, values in data.values.items():
        choice = prepared.choices[channel]
        data.columns[channel] = make_column(
            channel,
            choice.source,
            units.get(channel, torque_unit),
            choice.source in prepared.derived,
            values,
        )
    if prepared.rows_removed:
        count = prepared.rows_removed
        rows_are = "1 row" if count == 1 else f"{count} rows"
        data.notes.append(f"{rows_are} removed by where: {options.where}")
    if options.average:
        made = _averaged(data, joint, kind, torque_unit, position_unit, run, run_names, dropped)
        return with_drive(_with_rows(made, options.rows), prepared, data.values)
    made = _sampled(data, joint, kind, torque_unit, position_unit, run, run_names, dropped)
    made = _with_rows(made, options.rows)
    if not (standstill or made.moving.any()):
        raise _nothing_moves(made)
    made = with_drive(made, prepared, data.values)
    if options.hold_out is None:
        return made
    return with_hold_out(made, prepared, data.rows, options.hold_out)


def make_column(name: str, source: str, unit: str, derived: bool, values: Floats) -> Column:
    return Column(name, source, unit, derived, float(values.min()), float(values.max()))


def _with_rows(recording: Recording, rows: str) -> Recording:
    """The recording with the rows that are said to count."""
    if rows != "all":
        return recording
    return replace(
        recording,
        moving=_frozen(np.ones(len(recording.time)), np.bool_),
        velocity_threshold=0.0,
        notes=(*recording.notes, "every row counts, whether it moves or not, as said"),
    )


def _runs(data: Channels) -> tuple[tuple[str, ...], Ints]:
    if data.prepared.options.average == "row":
        return tuple(map(str, range(1, len(data.rows) + 1))), np.arange(len(data.rows))
    choice = data.prepared.choices.get("run")
    if choice is None:
        if data.prepared.options.average:
            raise RecordingError(
                f"{data.path}: --average run needs a run column: say which with --map run=COLUMN"
            )
        return ("",), np.zeros(len(data.rows), dtype=np.int64)
    names, number = numbered(labels(data.prepared.table[data.rows], choice.source))
    return tuple(names), number


def _drop_missing(data: Channels, run: Ints) -> None:
    """Drop rows with an empty, NaN or infinite cell; refuse when they are more than a few."""
    bad = np.zeros(len(data.rows), dtype=bool)
    worst, most = "", 0
    for channel, values in data.values.items():
        missing = ~np.isfinite(values)
        count = int(missing.sum())
        if count > most:
            worst, most = channel, count
        bad |= missing
    total = int(bad.sum())
    if not total:
        return
    source = data.prepared.choices[worst].source
    first = int(np.flatnonzero(~np.isfinite(data.values[worst]))[0])
    place = data.prepared.source.place(int(data.prepared.row[data.rows[first]]))
    if total >= _MISSING_SHARE * len(bad):
        optional = worst in ("temperature", "load_torque", "acceleration")
        advice = (
            f"leave the column out with --map {worst}=none"
            if optional
            else "mend the file or use --where"
        )
        raise RecordingError(
            f"{data.path}: {total} of {len(bad)} rows have empty, NaN or infinite cells, {most} "
            "of them "
            f"in column '{source}', first in {place}: {advice}"
        )
    data.notes.append(
        f"{total} of {len(bad)} rows with empty, NaN or infinite cells dropped as gaps "
        f"(first in {place}, column '{source}')"
    )
    data.keep(~bad)


def _check_time(data: Channels, run: Ints) -> None:
    n = len(data.rows)
    if n < 2:
        raise RecordingError(
            f"{data.path}: {n} sample is not a recording, at least two rows are needed"
        )
    if "time" not in data.values or data.prepared.options.average:
        return
    time = data.values["time"]
    step = np.diff(time)
    wrong = np.flatnonzero((step <= 0.0) & (run[1:] == run[:-1]))
    if not wrong.size:
        return
    at = int(wrong[0]) + 1
    place = data.prepared.source.place(int(data.prepared.row[data.rows[at]]))
    column = data.prepared.choices["time"].source
    before, now = time[at - 1], time[at]
    what = (
        f"is repeated ({now:.9g} s)"
        if now == before
        else f"runs backwards from {before:.9g} to {now:.9g} s"
    )
    if "run" in data.prepared.choices:
        inside = f" inside run '{_runs(data)[0][int(run[at])]}'"
        advice = (
            "correct the file, or name the column that tells the runs apart with --map run=COLUMN"
        )
    else:
        inside = ""
        guess = _run_columns(data, at)
        advice = (
            "if the file holds several runs say so with "
            + (f"--map run={guess[0]}" if guess else "--map run=COLUMN")
            + ", else remove that row"
        )
    raise RecordingError(f"{data.path}: {place}, column '{column}': time {what}{inside}: {advice}")


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


def settle_units(data: Channels) -> tuple[str, str, str]:
    """Settle joint kind and units: what was said, what the units say, else revolute.

    Returns
    -------
    tuple
        Joint kind, unit of torque, unit of position.
    """
    said = data.prepared.options.joint_kind
    linear = {"m", "m/s", "m/s2"}
    angular = {"rad", "rad/s", "rad/s2"}
    motion = {
        c: data.units[c] for c in ("position", "velocity", "acceleration") if data.units.get(c)
    }
    lines = [c for c, u in motion.items() if u in linear]
    turns = [c for c, u in motion.items() if u in angular]
    pitch = data.prepared.options.screw_pitch
    effort = next(
        (c for c in ("friction_torque", "torque", "current") if c in data.values), "torque"
    )
    effort_unit = data.units.get(effort, "")
    if lines and turns:
        raise RecordingError(
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but {turns[0]} in "
            f"{motion[turns[0]]}: "
            "a joint turns or slides; correct one with --unit COLUMN=UNIT"
        )
    if said == "revolute" and lines:
        raise RecordingError(
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but the joint is said to be "
            "revolute: "
            "give --joint-kind prismatic or its unit with --unit"
        )
    screw = said == "prismatic" and turns and pitch is not None
    if said == "prismatic" and turns and not screw:
        raise RecordingError(
            f"{data.path}: {turns[0]} is in {motion[turns[0]]} but the joint is said to be "
            "prismatic: "
            "give its unit with --unit, or screw_pitch (m per turn) in the sidecar"
        )
    if said is not None:
        kind = said
    elif lines:
        kind = "prismatic"
        data.notes.append(f"joint taken as prismatic: {lines[0]} is in {motion[lines[0]]}")
    elif turns:
        kind = "revolute"
        data.notes.append(f"joint taken as revolute: {turns[0]} is in {motion[turns[0]]}")
    elif effort_unit == "N":
        kind = "prismatic"
        data.notes.append(f"joint taken as prismatic: {effort} is in N")
    else:
        kind = "revolute"
        data.notes.append("joint kind not given, taken as revolute")
    if screw:
        assert pitch is not None
        per_rad = pitch / (2.0 * np.pi)
        for channel in motion:
            data.values[channel] = data.values[channel] * per_rad
        data.notes.append(
            f"motion and torque of the screw converted with its pitch of {pitch:g} m per turn"
        )
    natural = "N" if kind == "prismatic" else "N m"
    unit = effort_unit or natural
    if effort == "current":
        options = data.prepared.options
        assert options.torque_constant is not None
        gain = options.torque_constant * options.gear_ratio
        data.values["torque"] = data.values["current"] * gain
        data.columns["torque"] = make_column(
            "torque", f"{data.prepared.choices['current'].source} * {gain:g}", natural, True,
            data.values["torque"],
        )  # fmt: skip
        data.notes.append(
            f"torque = current * torque constant {options.torque_constant:g} * gear ratio "
            f"{options.gear_ratio:g}"
        )
        unit = "N m"
        del data.values["current"]
        data.prepared.choices.setdefault("torque", data.prepared.choices["current"])
        if kind == "prismatic" and not screw:
            # A linear motor's constant is in N/A; then the product is a force already.
            unit = "N"
    if screw and unit == "N m":
        for channel in ("torque", "load_torque", "friction_torque"):
            if channel in data.values:
                data.values[channel] = data.values[channel] / per_rad
        unit = "N"
    if kind == "prismatic" and unit == "N m":
        raise RecordingError(
            f"{data.path}: the joint is prismatic but {effort} is in N m: give screw_pitch (m "
            "per turn) "
            "with positions in rad in the sidecar, or --unit COLUMN=N"
        )
    if kind == "revolute" and unit == "N":
        raise RecordingError(
            f"{data.path}: the joint is revolute but {effort} is in N: give --joint-kind "
            "prismatic or "
            "--unit COLUMN=Nm"
        )
    load_unit = data.units.get("load_torque", "")
    same = screw or data.prepared.options.drive is not None
    if "load_torque" in data.values and load_unit and load_unit != unit and not same:
        raise RecordingError(
            f"{data.path}: load_torque is in {load_unit} but torque in {unit}: bring both to one "
            "unit"
        )
    return kind, unit, "m" if kind == "prismatic" else "rad"


def rigid_body_load(
    data: Channels, position: Floats | None, acceleration: Floats, unit: str, *, smooth: bool
) -> Floats | None:
    """Compute the load torque from rigid-body terms, None when none were given."""
    terms = data.prepared.options.terms
    if not terms:
        return None
    if position is None and ("gravity_cos" in terms or "gravity_sin" in terms):
        raise RecordingError(
            f"{data.path}: gravity_cos and gravity_sin need a position column: say which with "
            "--map position=COLUMN"
        )
    load = terms.get("inertia", 0.0) * acceleration + terms.get("gravity", 0.0)
    if position is not None:
        load = load + terms.get("gravity_cos", 0.0) * np.cos(position)
        load = load + terms.get("gravity_sin", 0.0) * np.sin(position)
    if not smooth:
        text = ", ".join(f"{key} {value:g}" for key, value in terms.items())
        data.notes.append(f"load torque computed from rigid-body terms: {text}")
        data.columns["load_torque"] = make_column(
            "load_torque", "rigid-body terms", unit, True, load
        )
    return load


def _frozen(values: Any, dtype: Any = np.float64) -> Any:
    array = np.array(values, dtype=dtype, order="C")
    array.flags.writeable = False
    return array


def _maybe(values: Floats | None) -> Any:
    return None if values is None else _frozen(values)


def measured_torque(data: Channels) -> tuple[Floats, Floats | None]:
    """Return the measured torque and the recorded load; zeros where friction alone is known."""
    if "friction_torque" in data.values:
        friction = data.values["friction_torque"]
        load = data.values.get("load_torque")
        data.notes.append(
            "friction was measured directly "
            f"('{data.prepared.choices['friction_torque'].source}'): it is the torque, "
            + ("and the load torque is zero" if load is None else "of which the load is no part")
        )
        source = data.columns["friction_torque"]
        data.columns["torque"] = Column(
            "torque", source.source, source.unit, source.derived, source.minimum, source.maximum
        )
        return friction, np.zeros_like(friction) if load is None else load
    return data.values["torque"], data.values.get("load_torque")


def _sampled(
    data: Channels,
    joint: str | None,
    kind: str,
    torque_unit: str,
    position_unit: str,
    run: Ints,
    run_names: tuple[str, ...],
    dropped: int,
) -> Recording:
    time = data.values["time"]
    row = data.prepared.row[data.rows]
    segment, dt, typical = segment_rows(time, run, row)
    position = data.values.get("position")
    velocity = data.values.get("velocity")
    acceleration = data.values.get("acceleration")
    if velocity is not None:
        sigma = noise_level(time, velocity, segment)
        cutoff = choose_cutoff(time, velocity, segment, 1)
        smoother = Smoother(time, segment, cutoff)
        velocity_smooth = smoother.smooth(velocity)
        origin, derivative, source = "velocity", 1, velocity
    else:
        assert position is not None
        # The raw difference quotient of two samples, each with the noise of the position.
        step = typical if typical > 0.0 else float(np.median(np.diff(time)))
        sigma = np.sqrt(2.0) * noise_level(time, position, segment) / step
        cutoff = choose_cutoff(time, position, segment, 2)
        smoother = Smoother(time, segment, cutoff)
        velocity = velocity_smooth = smoother.smooth(position, 1)
        origin, derivative, source = "position", 2, position
        data.columns["velocity"] = make_column(
            "velocity", "position", f"{position_unit}/s", True, velocity
        )
        data.notes.append(_derived_note("velocity", "position", cutoff))
    if acceleration is None:
        # Differentiation raises what lies above the motion, vibration that no rigid body
        # follows: where the noise does not end the band earlier, the motion does.
        band = motion_band(time, velocity, segment)
        bands = [x for x in (cutoff, None if band is None else BANDS * band) if x is not None]
        highest = min(bands, default=None)
        slope = Smoother(time, segment, highest).smooth(source, derivative)
        acceleration = acceleration_smooth = slope
        data.columns["acceleration"] = make_column(
            "acceleration", origin, f"{position_unit}/s2", True, acceleration
        )
        data.notes.append(_derived_note("acceleration", origin, highest))
    else:
        acceleration_smooth = smoother.smooth(acceleration)
    position_smooth = None if position is None else smoother.smooth(position)
    torque, load = measured_torque(data)
    load_smooth = None if load is None else smoother.smooth(load)
    load_unit = torque_unit if data.prepared.options.drive is None else natural_unit(kind)
    if load is None:
        load = rigid_body_load(data, position, acceleration, load_unit, smooth=False)
        if load is not None:
            load_smooth = rigid_body_load(
                data, position_smooth, acceleration_smooth, load_unit, smooth=True
            )
    top = float(np.abs(velocity).max())
    threshold = max(SIGMAS * sigma, 1e-6 * top)
    moving = np.abs(velocity) > threshold
    block, count = held_out_blocks(dt, segment, run, typical)
    gaps = len(segment_slices(segment)) - len(run_names)
    return Recording(
        path=data.path, sha256=data.prepared.source.sha256, joint=joint, joint_kind=kind,
        torque_unit=torque_unit, position_unit=position_unit,
        time=_frozen(time), segment=_frozen(segment, np.int64), run=_frozen(run, np.int64),
        run_names=run_names, dt=_frozen(dt),
        position=_maybe(position), velocity=_frozen(velocity), acceleration=_frozen(acceleration),
        torque=_frozen(torque), load_torque=_maybe(load),
        temperature=_maybe(data.values.get("temperature")),
        position_smooth=_maybe(position_smooth), velocity_smooth=_frozen(velocity_smooth),
        acceleration_smooth=_frozen(acceleration_smooth), load_torque_smooth=_maybe(load_smooth),
        columns=data.columns, notes=tuple(data.notes),
        velocity_noise=float(sigma), velocity_threshold=float(threshold),
        moving=_frozen(moving, np.bool_), block=_frozen(block, np.int64), block_count=count,
        rate_hz=1.0 / typical if typical > 0.0 else 0.0, gaps=gaps, rows_dropped=dropped,
        averaged=False, cutoff_hz=cutoff, motor=dict(data.prepared.options.motor),
    )  # fmt: skip


def _nothing_moves(recording: Recording) -> RecordingError:
    what = (
        "velocity is zero throughout"
        if not recording.velocity.any()
        else f"no row is faster than its own noise ({recording.velocity_threshold:.3g} "
        f"{recording.position_unit}/s)"
    )
    return RecordingError(f"{recording.path}: nothing moves, {what}: give a recording with motion")


def _derived_note(name: str, source: str, cutoff: float | None) -> str:
    if cutoff is None:
        return f"{name} derived from {source}, no filter: the data show no noise above the motion"
    return (
        f"{name} derived from {source}, zero-phase low-pass at {cutoff:.3g} Hz chosen from the data"
    )


def _averaged(
    data: Channels,
    joint: str | None,
    kind: str,
    torque_unit: str,
    position_unit: str,
    run: Ints,
    run_names: tuple[str, ...],
    dropped: int,
) -> Recording:
    if "velocity" not in data.values:
        raise RecordingError(
            f"{data.path}: --average run needs a velocity column: say which with --map "
            "velocity=COLUMN"
        )
    n = len(run_names)
    starts = np.flatnonzero(np.concatenate(([True], run[1:] != run[:-1])))
    parts = np.split(np.arange(len(run)), starts[1:])
    if n < 2:
        raise RecordingError(
            f"{data.path}: one run averages to one point, at least two runs are needed"
        )
    errors = np.array([_median_error(data.values["velocity"][part]) for part in parts])
    medians = {
        name: np.array([float(np.median(values[part])) for part in parts])
        for name, values in data.values.items()
    }
    data.values = medians
    velocity = medians["velocity"]
    # The threshold parts slow runs from standing ones, and scatter grows with speed: the slowest
    # quarter of the runs says how well a slow median is known.
    slowest = np.argsort(np.abs(velocity), kind="stable")[: max(1, n // 4)]
    sigma = float(np.median(errors[slowest]))
    position = medians.get("position")
    still = np.zeros(n)
    data.columns["acceleration"] = Column(
        "acceleration", "steady runs", f"{position_unit}/s2", True, 0.0, 0.0
    )
    data.notes.append(
        f"each of {n} rows is a steady-state point, acceleration zero"
        if data.prepared.options.average == "row"
        else f"one row per run: the median of each channel over {n} runs, acceleration zero"
    )
    torque, load = measured_torque(data)
    if load is None:
        load = rigid_body_load(data, position, still, torque_unit, smooth=False)
    if load is None and position is None:
        # Neither inertia nor gravity could be told from steady points without a position.
        load = still
        data.notes.append(
            "steady runs without position or load: all of the torque is taken as friction"
        )
    top = float(np.abs(velocity).max())
    threshold = max(SIGMAS * sigma, 1e-6 * top)
    moving = np.abs(velocity) > threshold
    if not moving.any() and data.prepared.options.rows != "all":
        raise RecordingError(f"{data.path}: nothing moves in any run: give a recording with motion")
    order = np.arange(n)
    for name in ("position", "velocity", "torque", "load_torque", "friction_torque", "temperature"):
        if name in medians and name in data.columns:
            old = data.columns[name]
            data.columns[name] = make_column(name, old.source, old.unit, old.derived, medians[name])
    count = n if n >= 5 else min(10, n)
    return Recording(
        path=data.path, sha256=data.prepared.source.sha256, joint=joint, joint_kind=kind,
        torque_unit=torque_unit, position_unit=position_unit,
        time=_frozen(order), segment=_frozen(order, np.int64), run=_frozen(order, np.int64),
        run_names=run_names, dt=_frozen(still),
        position=_maybe(position), velocity=_frozen(velocity), acceleration=_frozen(still),
        torque=_frozen(torque), load_torque=_maybe(load),
        temperature=_maybe(medians.get("temperature")),
        position_smooth=_maybe(position), velocity_smooth=_frozen(velocity),
        acceleration_smooth=_frozen(still), load_torque_smooth=_maybe(load),
        columns=data.columns, notes=tuple(data.notes),
        velocity_noise=sigma, velocity_threshold=float(threshold),
        moving=_frozen(moving, np.bool_), block=_frozen(order, np.int64), block_count=count,
        rate_hz=0.0, gaps=0, rows_dropped=dropped, averaged=True, cutoff_hz=None,
        motor=dict(data.prepared.options.motor),
    )  # fmt: skip


def _median_error(values: Floats) -> float:
    """Standard error of the median of one steady run, from its robust scatter."""
    scatter = float(np.median(np.abs(values - np.median(values)))) / 0.6745
    # The scatter of a coarsely quantised channel is at least that of its steps.
    scatter = max(scatter, quantisation_step(values) / np.sqrt(12.0))
    return float(1.2533 * scatter / np.sqrt(len(values)))
