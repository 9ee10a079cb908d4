"""The `Recording` type and the functions that read one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ..errors import RecordingError
from .columns import file_unit, wide_groups
from .derive import Smoother, choose_cutoff
from .options import Pairs, gather
from .readers import read_table
from .rows import (
    SIGMAS,
    held_out_blocks,
    noise_level,
    quantisation_step,
    segment_rows,
    segment_slices,
)
from .table import (
    Prepared,
    apply_formulas,
    channel_values,
    column_numbers,
    joint_rows,
    joints_of,
    labels,
    prepare,
)

__all__ = ["Column", "FileColumn", "Recording", "Table", "read", "read_all", "scan"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_MISSING_SHARE = 0.05
_EFFORTS = {"torque": "N m", "force": "N", "voltage": "V", "percent": "%"}


@dataclass(frozen=True)
class Column:
    """A channel of a recording and where it comes from.

    Attributes
    ----------
    name
        Channel, e.g. ``velocity``.
    source
        Column of the file, or what it was computed from.
    unit
        SI unit of the channel.
    derived
        True when it was computed and not read.
    minimum, maximum
        Range in that unit.
    """

    name: str
    source: str
    unit: str
    derived: bool
    minimum: float = float("nan")
    maximum: float = float("nan")


@dataclass(frozen=True, eq=False, repr=False)
class Recording:
    """One joint's measurements, checked, in SI units; arrays are read-only.

    `time` [s], `position` [rad or m], `velocity`, `acceleration`, `temperature` [degC], `torque` as
    it was recorded and `load_torque` (None: not known, to be identified) in `torque_unit`. The
    ``*_smooth`` arrays are zero-phase low-passed at `cutoff_hz` on the same rows. `dt` [s] is the
    step to the previous sample, 0 where a segment (run, or stretch between gaps) starts. `moving`
    marks the scored rows, `block` the held-out blocks.
    """

    path: str
    sha256: str
    joint: str | None
    joint_kind: str
    torque_unit: str
    position_unit: str
    time: Floats
    segment: Ints
    run: Ints
    run_names: tuple[str, ...]
    dt: Floats
    position: Floats | None
    velocity: Floats
    acceleration: Floats
    torque: Floats
    load_torque: Floats | None
    temperature: Floats | None
    position_smooth: Floats | None
    velocity_smooth: Floats
    acceleration_smooth: Floats
    load_torque_smooth: Floats | None
    columns: dict[str, Column]
    notes: tuple[str, ...]
    velocity_noise: float
    velocity_threshold: float
    moving: Bools
    block: Ints
    block_count: int
    rate_hz: float
    gaps: int
    rows_dropped: int
    averaged: bool
    cutoff_hz: float | None
    motor: dict[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.time)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.time)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    def __repr__(self) -> str:
        joint = f", joint {self.joint}" if self.joint else ""
        return (
            f"<Recording {Path(self.path).name}{joint}: {self.rows} rows, {self.runs} run"
            f"{'s' if self.runs > 1 else ''}, {self.rate_hz:.4g} Hz, {self.joint_kind}, {self.torque_unit}>"
        )

    def scored(self) -> dict[str, float]:
        """Return the ``scored`` object of the JSON output: rows, share, velocity_threshold."""
        rows = int(self.moving.sum())
        return {
            "rows": rows,
            "share": rows / len(self.moving),
            "velocity_threshold": self.velocity_threshold,
        }

    def columns_for_model(self, smooth: bool = False) -> dict[str, Floats | None]:
        """Return what a friction law reads, by argument name.

        Parameters
        ----------
        smooth
            Take the low-passed kinematics and load.
        """
        return {
            "dt": self.dt,
            "velocity": self.velocity_smooth if smooth else self.velocity,
            "position": self.position_smooth if smooth else self.position,
            "acceleration": self.acceleration_smooth if smooth else self.acceleration,
            "temperature": self.temperature,
            "load_torque": self.load_torque_smooth if smooth else self.load_torque,
            "motor_torque": self.torque,
        }

    def scales(self) -> dict[str, float]:
        """Return typical sizes for scaling parameters, each in the channel's unit.

        speed (99.9th percentile over moving rows), torque (rms over moving rows), position
        (excursion), acceleration (99th percentile of the smooth one), sample_period (median step),
        temperature (span). A channel that is absent has scale 0.
        """
        moving = self.moving if self.moving.any() else np.ones(len(self.moving), dtype=bool)
        steps = self.dt[self.dt > 0.0]
        return {
            "speed": float(np.percentile(np.abs(self.velocity[moving]), 99.9)),
            "torque": float(np.sqrt(np.mean(self.torque[moving] ** 2))),
            "position": float(np.ptp(self.position)) if self.position is not None else 0.0,
            "acceleration": float(np.percentile(np.abs(self.acceleration_smooth), 99.0)),
            "sample_period": float(np.median(steps)) if steps.size else 0.0,
            "temperature": float(np.ptp(self.temperature)) if self.temperature is not None else 0.0,
        }

    def to_frame(self) -> pl.DataFrame:
        """Return the channels as a polars frame, one row a sample."""
        data: dict[str, Any] = {"time": self.time}
        for name in (
            "position",
            "velocity",
            "acceleration",
            "torque",
            "load_torque",
            "temperature",
        ):
            values = getattr(self, name)
            if values is not None:
                data[name] = values
        data["run"] = [self.run_names[i] for i in self.run]
        data["moving"] = self.moving
        return pl.DataFrame(data)


@dataclass(frozen=True)
class FileColumn:
    """A column as the file has it: its type, the unit its name carries, its range and empty cells."""

    name: str
    dtype: str
    unit: str | None
    minimum: float | None
    maximum: float | None
    missing: int
    derived: bool
    channel: str | None


@dataclass(frozen=True)
class Table:
    """What is in a file before a joint is selected.

    Attributes
    ----------
    rows
        Rows that `where` leaves.
    joints
        Joints of a joint column, or the joint numbers of a wide file.
    columns
        Every column of the file.
    channels
        Channel -> column read for it, unit and range in SI.
    problem
        The sentence with which reading a joint would be refused, as far as the columns tell.
    """

    path: str
    sha256: str
    rows: int
    joints: tuple[str, ...]
    wide: bool
    runs: int
    columns: tuple[FileColumn, ...]
    channels: dict[str, Column]
    rate_hz: float | None
    gaps: int | None
    problem: str | None
    notes: tuple[str, ...]


# ------------------------------------------------------------------------------------- reading


def read(
    path: str | Path,
    *,
    sidecar: str | Path | None = None,
    joint: str | None = None,
    joint_kind: str | None = None,
    gear_ratio: float | None = None,
    torque_constant: float | None = None,
    inertia: float | None = None,
    unit: Pairs = (),
    map: Pairs = (),
    derive: Pairs = (),
    where: str | None = None,
    average: str | None = None,
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
    unit
        ``"COLUMN=UNIT"`` texts: the unit of a column of the file.
    map
        ``"NAME=COLUMN"`` texts: which column of the file a channel is; ``NAME=none`` leaves it out.
    derive
        ``"NAME=FORMULA"`` texts: new columns from those of the file, in the file's own units.
    where
        Condition on the columns; rows that fail it become gaps.
    average
        ``"run"``: one row per run, the median of each channel.

    Raises
    ------
    RecordingError
        One sentence that says what is wrong, where, and what to do.
    """
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, unit=unit, map=map, derive=derive,
        where=where, average=average,
    )  # fmt: skip
    prepared = prepare(str(path), options)
    name, rows = joint_rows(prepared, options.joint)
    return _build(prepared, name, rows)


def read_all(
    path: str | Path,
    *,
    sidecar: str | Path | None = None,
    joint: str | None = None,
    joint_kind: str | None = None,
    gear_ratio: float | None = None,
    torque_constant: float | None = None,
    inertia: float | None = None,
    unit: Pairs = (),
    map: Pairs = (),
    derive: Pairs = (),
    where: str | None = None,
    average: str | None = None,
) -> list[Recording]:
    """Read every joint of a recording, in order of appearance; see `read`."""
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, unit=unit, map=map, derive=derive,
        where=where, average=average,
    )  # fmt: skip
    prepared = prepare(str(path), options)
    wanted: Iterable[str | None] = joints_of(prepared) or [None]
    if options.joint is not None:
        wanted = [options.joint]
    return [_build(prepared, *joint_rows(prepared, name)) for name in wanted]


def _need(prepared: Prepared) -> None:
    """Refuse a table that lacks what every analysis needs."""
    path = prepared.source.path
    have = prepared.choices
    there = f"the file has {', '.join(prepared.table.columns)}"
    if "time" not in have and not prepared.options.average:
        raise RecordingError(
            f"{path}: there is no time column; {there}: say which with --map time=COLUMN"
        )
    if "velocity" not in have and "position" not in have:
        raise RecordingError(
            f"{path}: there is neither a velocity nor a position column; {there}: say which with "
            "--map velocity=COLUMN or --map position=COLUMN"
        )
    if "torque" not in have and "friction_torque" not in have:
        if "current" in have:
            if prepared.options.torque_constant is not None:
                return
            raise RecordingError(
                f"{path}: there is a current ('{have['current'].source}') but no torque: give "
                "--torque-constant NM_PER_A (and --gear-ratio), or --map torque=COLUMN"
            )
        raise RecordingError(
            f"{path}: there is no torque column; {there}: say which with --map torque=COLUMN, or make "
            "one with --derive torque=FORMULA"
        )


class _Channels:
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
                f"{channel} is read from '{choice.source}' in {choice.unit.name}, converted to {unit}"
            )
        elif choice.unit is not None and choice.said_by == "option" and choice.unit.name != unit:
            self.notes.append(
                f"'{choice.source}' is in {choice.unit.name} as said, converted to {unit}"
            )

    def keep(self, mask: Bools) -> None:
        self.rows = self.rows[mask]
        self.values = {name: values[mask] for name, values in self.values.items()}


def _wanted(prepared: Prepared) -> list[str]:
    have = prepared.choices
    motion = ("time", "position", "velocity", "acceleration", "temperature")
    wanted: list[str] = [c for c in motion if c in have]
    # Friction measured directly stands instead of torque and load; where a file has all three
    # without being told, the torque is what was measured and the friction what someone computed.
    direct = "friction_torque" in have and (
        "friction_torque" in prepared.options.maps
        or not ("torque" in have and "load_torque" in have)
    )
    if direct:
        return [*wanted, "friction_torque"]
    if "torque" in have:
        wanted.append("torque")
    elif "current" in have:
        wanted.append("current")
    if "load_torque" in have:
        wanted.append("load_torque")
    return wanted


def _build(prepared: Prepared, joint: str | None, rows: Ints) -> Recording:
    _need(prepared)
    options = prepared.options
    path = prepared.source.path
    data = _Channels(prepared, rows)
    for channel in _wanted(prepared):
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
    kind, torque_unit, position_unit = _kinds(data)
    velocity_unit, acceleration_unit = f"{position_unit}/s", f"{position_unit}/s2"
    units = {
        "time": "s", "position": position_unit, "velocity": velocity_unit,
        "acceleration": acceleration_unit, "temperature": "degC", "current": "A",
    }  # fmt: skip
    for channel, values in data.values.items():
        choice = prepared.choices[channel]
        data.columns[channel] = _column(
            channel,
            choice.source,
            units.get(channel, torque_unit),
            choice.source in prepared.derived,
            values,
        )
    if prepared.rows_removed:
        data.notes.append(f"{prepared.rows_removed} rows removed by where: {options.where}")
    if options.average:
        return _averaged(data, joint, kind, torque_unit, position_unit, run, run_names, dropped)
    return _sampled(data, joint, kind, torque_unit, position_unit, run, run_names, dropped)


def _column(name: str, source: str, unit: str, derived: bool, values: Floats) -> Column:
    return Column(name, source, unit, derived, float(values.min()), float(values.max()))


def _runs(data: _Channels) -> tuple[tuple[str, ...], Ints]:
    choice = data.prepared.choices.get("run")
    if choice is None:
        if data.prepared.options.average:
            raise RecordingError(
                f"{data.path}: --average run needs a run column: say which with --map run=COLUMN"
            )
        return ("",), np.zeros(len(data.rows), dtype=np.int64)
    names = labels(data.prepared.table[data.rows], choice.source)
    number: dict[str, int] = {}
    codes = np.fromiter(
        (number.setdefault(n, len(number)) for n in names), dtype=np.int64, count=len(names)
    )
    return tuple(number), codes


def _drop_missing(data: _Channels, run: Ints) -> None:
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
            f"{data.path}: {total} of {len(bad)} rows have empty, NaN or infinite cells, {most} of them "
            f"in column '{source}', first in {place}: {advice}"
        )
    data.notes.append(
        f"{total} of {len(bad)} rows with empty, NaN or infinite cells dropped as gaps "
        f"(first in {place}, column '{source}')"
    )
    data.keep(~bad)


def _check_time(data: _Channels, run: Ints) -> None:
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


def _run_columns(data: _Channels, at: int) -> list[str]:
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


def _kinds(data: _Channels) -> tuple[str, str, str]:
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
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but {turns[0]} in {motion[turns[0]]}: "
            "a joint turns or slides; correct one with --unit COLUMN=UNIT"
        )
    if said == "revolute" and lines:
        raise RecordingError(
            f"{data.path}: {lines[0]} is in {motion[lines[0]]} but the joint is said to be revolute: "
            "give --joint-kind prismatic or its unit with --unit"
        )
    screw = said == "prismatic" and turns and pitch is not None
    if said == "prismatic" and turns and not screw:
        raise RecordingError(
            f"{data.path}: {turns[0]} is in {motion[turns[0]]} but the joint is said to be prismatic: "
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
        data.columns["torque"] = _column(
            "torque", f"{data.prepared.choices['current'].source} * {gain:g}", natural, True,
            data.values["torque"],
        )  # fmt: skip
        data.notes.append(
            f"torque = current * torque constant {options.torque_constant:g} * gear ratio {options.gear_ratio:g}"
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
            f"{data.path}: the joint is prismatic but {effort} is in N m: give screw_pitch (m per turn) "
            "with positions in rad in the sidecar, or --unit COLUMN=N"
        )
    if kind == "revolute" and unit == "N":
        raise RecordingError(
            f"{data.path}: the joint is revolute but {effort} is in N: give --joint-kind prismatic or "
            "--unit COLUMN=Nm"
        )
    load_unit = data.units.get("load_torque", "")
    if "load_torque" in data.values and load_unit and load_unit != unit and not screw:
        raise RecordingError(
            f"{data.path}: load_torque is in {load_unit} but torque in {unit}: bring both to one unit"
        )
    return kind, unit, "m" if kind == "prismatic" else "rad"


def _load(
    data: _Channels, position: Floats | None, acceleration: Floats, unit: str, *, smooth: bool
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
        data.columns["load_torque"] = _column("load_torque", "rigid-body terms", unit, True, load)
    return load


def _frozen(values: Any, dtype: Any = np.float64) -> Any:
    array = np.array(values, dtype=dtype, order="C")
    array.flags.writeable = False
    return array


def _maybe(values: Floats | None) -> Any:
    return None if values is None else _frozen(values)


def _torque(data: _Channels) -> tuple[Floats, Floats | None]:
    """Return the measured torque and the recorded load, zeros where friction was measured."""
    if "friction_torque" in data.values:
        friction = data.values["friction_torque"]
        data.notes.append(
            f"friction was measured directly ('{data.prepared.choices['friction_torque'].source}'): "
            "it is the torque, and the load torque is zero"
        )
        source = data.columns["friction_torque"]
        data.columns["torque"] = Column(
            "torque", source.source, source.unit, source.derived, source.minimum, source.maximum
        )
        return friction, np.zeros_like(friction)
    return data.values["torque"], data.values.get("load_torque")


def _sampled(
    data: _Channels,
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
        slope = smoother.smooth(velocity, 1)
        origin = "velocity"
    else:
        assert position is not None
        # The raw difference quotient of two samples, each with the noise of the position.
        step = typical if typical > 0.0 else float(np.median(np.diff(time)))
        sigma = np.sqrt(2.0) * noise_level(time, position, segment) / step
        cutoff = choose_cutoff(time, position, segment, 2)
        smoother = Smoother(time, segment, cutoff)
        velocity = velocity_smooth = smoother.smooth(position, 1)
        slope = smoother.smooth(position, 2)
        origin = "position"
        data.columns["velocity"] = _column(
            "velocity", "position", f"{position_unit}/s", True, velocity
        )
        data.notes.append(_derived_note("velocity", "position", cutoff))
    if acceleration is None:
        acceleration = acceleration_smooth = slope
        data.columns["acceleration"] = _column(
            "acceleration", origin, f"{position_unit}/s2", True, acceleration
        )
        data.notes.append(_derived_note("acceleration", origin, cutoff))
    else:
        acceleration_smooth = smoother.smooth(acceleration)
    position_smooth = None if position is None else smoother.smooth(position)
    torque, load = _torque(data)
    load_smooth = None if load is None else smoother.smooth(load)
    if load is None:
        load = _load(data, position, acceleration, torque_unit, smooth=False)
        if load is not None:
            load_smooth = _load(
                data, position_smooth, acceleration_smooth, torque_unit, smooth=True
            )
    top = float(np.abs(velocity).max())
    threshold = max(SIGMAS * sigma, 1e-6 * top)
    moving = np.abs(velocity) > threshold
    if not moving.any():
        what = (
            "velocity is zero throughout"
            if top == 0.0
            else (f"no row is faster than its own noise ({threshold:.3g} {position_unit}/s)")
        )
        raise RecordingError(f"{data.path}: nothing moves, {what}: give a recording with motion")
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


def _derived_note(name: str, source: str, cutoff: float | None) -> str:
    if cutoff is None:
        return f"{name} derived from {source}, no filter: the data show no noise above the motion"
    return (
        f"{name} derived from {source}, zero-phase low-pass at {cutoff:.3g} Hz chosen from the data"
    )


def _averaged(
    data: _Channels,
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
            f"{data.path}: --average run needs a velocity column: say which with --map velocity=COLUMN"
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
        f"one row per run: the median of each channel over {n} runs, acceleration zero"
    )
    torque, load = _torque(data)
    if load is None:
        load = _load(data, position, still, torque_unit, smooth=False)
    if load is None and position is None:
        # Neither inertia nor gravity could be told from steady points without a position.
        load = still
        data.notes.append(
            "steady runs without position or load: all of the torque is taken as friction"
        )
    top = float(np.abs(velocity).max())
    threshold = max(SIGMAS * sigma, 1e-6 * top)
    moving = np.abs(velocity) > threshold
    if not moving.any():
        raise RecordingError(f"{data.path}: nothing moves in any run: give a recording with motion")
    order = np.arange(n)
    for name in ("position", "velocity", "torque", "load_torque", "friction_torque", "temperature"):
        if name in medians and name in data.columns:
            old = data.columns[name]
            data.columns[name] = _column(name, old.source, old.unit, old.derived, medians[name])
    count = n if n >= 5 else min(10, n)
    return Recording(
        path=data.path, sha256=data.prepared.source.sha256, joint=joint, joint_kind=kind,
        torque_unit=torque_unit, position_unit=position_unit,
        time=_frozen(order), segment=_frozen(order, np.int64), run=_frozen(order, np.int64),
        run_names=run_names, dt=_frozen(still),
        position=_maybe(position), velocity=_frozen(velocity), acceleration=_frozen(still),
        torque=_frozen(torque), load_torque=_maybe(load), temperature=_maybe(medians.get("temperature")),
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


# ------------------------------------------------------------------------------------ scanning


def scan(
    path: str | Path,
    *,
    sidecar: str | Path | None = None,
    joint: str | None = None,
    joint_kind: str | None = None,
    gear_ratio: float | None = None,
    torque_constant: float | None = None,
    inertia: float | None = None,
    unit: Pairs = (),
    map: Pairs = (),
    derive: Pairs = (),
    where: str | None = None,
    average: str | None = None,
) -> Table:
    """Look at a file without selecting a joint; see `read` for the options."""
    options = gather(
        path, sidecar=sidecar, joint=joint, joint_kind=joint_kind, gear_ratio=gear_ratio,
        torque_constant=torque_constant, inertia=inertia, unit=unit, map=map, derive=derive,
        where=where, average=average,
    )  # fmt: skip
    problem: str | None = None
    prepared: Prepared | None
    try:
        prepared = prepare(str(path), options)
        source, table = prepared.source, prepared.table
        _need(prepared)
    except RecordingError as error:
        problem = str(error)
        # A file that cannot be opened, or a wrong formula, is refused here as it is by `read`.
        source = read_table(str(path))
        table, row, derived, _, notes = apply_formulas(source, options)
        prepared = Prepared(
            source,
            options,
            table,
            row,
            {},
            derived,
            source.table.height - table.height,
            tuple(notes),
        )
    wide = wide_groups(table.columns) if not prepared.choices else {}
    joints = tuple(joints_of(prepared)) or tuple(next(iter(wide.values()), {}))
    used = {choice.source: channel for channel, choice in prepared.choices.items()}
    columns = tuple(
        _file_column(table[name], name in prepared.derived, used.get(name))
        for name in table.columns
    )
    channels: dict[str, Column] = {}
    for channel, choice in prepared.choices.items():
        if channel in ("joint", "run"):
            continue
        try:
            values, si, _ = channel_values(prepared, channel, np.arange(table.height))
        except RecordingError as error:
            problem = problem or str(error)
            continue
        finite = values[np.isfinite(values)]
        if finite.size:
            channels[channel] = _column(
                channel, choice.source, si, choice.source in prepared.derived, finite
            )
    runs, rate, gaps = _pace(prepared)
    return Table(
        source.path, source.sha256, table.height, joints, bool(wide), runs, columns, channels, rate,
        gaps, problem, prepared.notes,
    )  # fmt: skip


def _file_column(series: pl.Series, derived: bool, channel: str | None) -> FileColumn:
    unit = file_unit(series.name)
    low = high = None
    missing = series.null_count()
    if series.dtype.is_numeric():
        values = series.cast(pl.Float64).drop_nulls().to_numpy()
        finite = values[np.isfinite(values)]
        missing += len(values) - len(finite)
        if finite.size:
            low, high = float(finite.min()), float(finite.max())
    return FileColumn(
        series.name,
        str(series.dtype),
        unit.name if unit else None,
        low,
        high,
        int(missing),
        derived,
        channel,
    )


def _pace(prepared: Prepared) -> tuple[int, float | None, int | None]:
    """Count runs and gaps and find the rate over every joint of a file."""
    choices = prepared.choices
    if "time" not in choices:
        return 1, None, None
    try:
        time = column_numbers(prepared.source, prepared.table, prepared.row, choices["time"].source)
    except RecordingError:
        return 1, None, None
    if choices["time"].unit is not None:
        time = time * choices["time"].unit.factor
    keys = [labels(prepared.table, choices[c].source) for c in ("joint", "run") if c in choices]
    number: dict[tuple[str, ...], int] = {}
    rows = zip(*keys, strict=True) if keys else (("",) for _ in range(len(time)))
    code = np.fromiter(
        (number.setdefault(k, len(number)) for k in rows), dtype=np.int64, count=len(time)
    )
    order = np.argsort(code, kind="stable")
    segment, _, typical = segment_rows(time[order], code[order], prepared.row[order])
    gaps = int(segment[-1]) + 1 - len(number)
    return len(number), 1.0 / typical if typical > 0.0 else None, gaps
