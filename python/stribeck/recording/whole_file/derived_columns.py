"""What formulas see of a whole table: derivatives, means, and channels that are no columns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError, option
from stribeck.recording.acceleration_filter import filter_text
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.derive import Smoother, choose_cutoff
from stribeck.recording.joint.channels import Channels
from stribeck.recording.joint.samples import check_time, in_runs
from stribeck.recording.joint.units import settle_units
from stribeck.recording.mend.rows import drop_bad_rows
from stribeck.recording.mend.stamps import drop_repeated_stamps
from stribeck.recording.mend.wraps import unwrap
from stribeck.recording.motion.derived_motion import acceleration_cutoff, slope
from stribeck.recording.naming.columns import choose_columns
from stribeck.recording.naming.names import CHANNELS, parse_name
from stribeck.recording.rows import segment_rows
from stribeck.recording.stated.settings import Settings
from stribeck.recording.tables.column_functions import Over
from stribeck.recording.tables.prepared import Prepared, channel_values, joint_rows, joints_of
from stribeck.recording.tables.readers import Source

__all__ = ["Whole", "wide_index"]

_MOTION = ("position", "velocity", "acceleration")


def wide_index(source: Source, table: pl.DataFrame, settings: Settings) -> str | None:
    """The joint of a wide file that was named, where there is no joint column."""
    if settings.joint is None or "joint" in settings.maps or "joint" in settings.derive:
        return None
    if any(parse_name(name).channel == "joint" for name in table.columns):
        return None
    if settings.joint in source.joints:
        return source.joints[settings.joint]
    return settings.joint.removeprefix("joint_").removeprefix("joint")


@dataclass(frozen=True)
class Whole:
    """A whole file while its formulas are computed."""

    source: Source
    settings: Settings

    def over(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> Over:
        """The functions `names` of all samples of each joint; filters are stated in `notes`.

        Raises
        ------
        RecordingError
            There is no time column, or time does not increase.
        """
        prepared = self._prepared(table, ("time", "joint", "run"))
        rows = [joint_rows(prepared, joint)[1] for joint in _joints(prepared)]
        clocks = list(self._of_joints(prepared, (), where)) if "diff" in names else []

        def diff(values: Floats) -> Floats:
            found = np.full(table.height, np.nan)
            for data, run in clocks:
                found[data.rows], cutoff = _slope(data, run, values)
                note = f"{where.removeprefix(f'{self.source.path}: ')}: diff, {filter_text(cutoff)}"
                if note not in notes:
                    notes.append(note)
            return found

        def mean(values: Floats) -> Floats:
            found = np.full(table.height, np.nan)
            for own in rows:
                finite = np.isfinite(values[own])
                if finite.any():
                    found[own] = values[own][finite].mean()
            return found

        return Over(diff, mean)

    def channels(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> dict[str, Floats]:
        """Channels in SI units, [rows] each; NaN in rows that are left out.

        A velocity or acceleration that is no column is derived as that of the recording.

        Raises
        ------
        RecordingError
            A channel is not there and cannot be derived.
        """
        motion = tuple(name for name in names if name in _MOTION)
        found = self._motion(table, motion, where, notes) if motion else {}
        others = tuple(name for name in names if name not in _MOTION)
        prepared = self._prepared(table, others)
        for name in others:
            if name == "torque" and name not in prepared.choices:
                found[name] = self._torque(table, where)
                continue
            if name not in prepared.choices:
                raise self._missing(name, where, "")
            found[name], _, _ = channel_values(prepared, name, np.arange(table.height))
        return found

    def _prepared(self, table: pl.DataFrame, wanted: tuple[str, ...]) -> Prepared:
        """The table with the columns of some channels chosen from those that are there by now."""
        settings = self.settings
        there = (*table.columns, "none")
        choices, _ = choose_columns(
            self.source.path,
            table.columns,
            derived=tuple(name for name in settings.derive if name in there),
            maps={c: column for c, column in settings.maps.items() if column in there},
            units={c: u for c, u in settings.units.items() if c in there or c in CHANNELS},
            index=wide_index(self.source, table, settings),
            wanted=wanted,
        )
        settings = replace(settings, average=None, torque_at=None)
        return Prepared(self.source, settings, table, np.arange(table.height), choices, ())

    def _of_joints(
        self, prepared: Prepared, channels: tuple[str, ...], where: str
    ) -> Iterator[tuple[Channels, Ints]]:
        """The samples of each joint in the order of time, and their runs."""
        if "time" not in prepared.choices:
            raise RecordingError(
                f"{where}: a derivative needs a time column: name it with "
                f"{option('map', 'time=COLUMN')}"
            )
        for joint in _joints(prepared):
            name, rows = joint_rows(prepared, joint)
            own = replace(prepared, settings=prepared.settings.for_joint(name))
            data = Channels(own, rows)
            for channel in ("time", *channels):
                data.load(channel)
            finite = np.all([np.isfinite(values) for values in data.values.values()], axis=0)
            data.join(finite)
            _, run = in_runs(data)
            order = np.argsort(run, kind="stable")
            data.reorder(order)
            run = drop_repeated_stamps(data, run[order])
            check_time(data, run)
            yield data, run

    def _motion(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> dict[str, Floats]:
        """Position, velocity or acceleration, [rows] each."""
        prepared = self._prepared(table, ("time", "joint", "run", "current", *_MOTION))
        have = tuple(c for c in (*_MOTION, "current") if c in prepared.choices)
        found = {name: np.full(table.height, np.nan) for name in names}
        for name in names:
            if name not in have and (name == "position" or not {"position", "velocity"} & {*have}):
                from_what = "" if name == "position" else ", and no position to derive it from"
                raise self._missing(name, where, from_what)
        if set(names) <= set(have) and "time" not in prepared.choices:
            return {
                name: channel_values(prepared, name, np.arange(table.height))[0] for name in names
            }
        for data, run in self._of_joints(prepared, have, where):
            run = drop_bad_rows(data, run)
            unwrap(data, run)
            data.values.pop("current", None)
            settle_units(data)
            notes += [note for note in _derive(data, run, names) if note not in notes]
            for name in names:
                found[name][data.rows] = data.values[name]
        return found

    def _torque(self, table: pl.DataFrame, where: str) -> Floats:
        """The torque at the joint that a current makes, [rows]."""
        prepared = self._prepared(table, ("joint", "run", "current", *_MOTION))
        found = np.full(table.height, np.nan)
        for joint in _joints(prepared):
            name, rows = joint_rows(prepared, joint)
            settings = prepared.settings.for_joint(name)
            if "current" not in prepared.choices or settings.mechanics.torque_constant is None:
                raise self._missing("torque", where, ", and no current with a torque constant")
            data = Channels(replace(prepared, settings=settings), rows)
            for channel in ("current", *(c for c in _MOTION if c in prepared.choices)):
                data.load(channel)
            settle_units(data)
            found[rows] = data.values["torque"]
        return found

    def _missing(self, name: str, where: str, further: str) -> RecordingError:
        there = ", ".join(self.source.table.columns)
        return RecordingError(
            f"{where}: there is no column for the channel '{name}'{further}; the file has {there}: "
            f"name it with {option('map', f'{name}=COLUMN')}"
        )


def _joints(prepared: Prepared) -> list[str | None]:
    """The joints of a file; None stands for the one joint of a file without a joint column."""
    return [*joints_of(prepared)] or [None]


def _slope(data: Channels, run: Ints, values: Floats) -> tuple[Floats, float | None]:
    """The derivative of a column along the samples of a joint, [n], and its cut-off."""
    own = values[data.rows]
    finite = np.isfinite(own)
    found = np.full(own.size, np.nan)
    time = data.values["time"][finite]
    if time.size < 2:
        return found, None
    segment, _, _ = segment_rows(time, run[finite], data.sequence[finite])
    found[finite], cutoff = slope(time, own[finite], segment)
    return found, cutoff


def _derive(data: Channels, run: Ints, names: tuple[str, ...]) -> list[str]:
    """Add the velocity and acceleration that are wanted and not there; notes on the filters."""
    notes: list[str] = []
    time = data.values["time"]
    segment, _, typical = segment_rows(time, run, data.sequence)
    origin = "velocity" if "velocity" in data.values else "position"
    cutoff = None
    if origin == "velocity":
        cutoff = choose_cutoff(time, data.values["velocity"], segment, 1)
    if origin == "position" and {"velocity", "acceleration"} & {*names}:
        data.values["velocity"], cutoff = slope(time, data.values["position"], segment)
        notes.append(f"velocity in formulas: derived from position, {filter_text(cutoff)}")
    if "acceleration" in names and "acceleration" not in data.values:
        highest = acceleration_cutoff(time, data.values["velocity"], segment, typical, cutoff)
        derivative = 1 if origin == "velocity" else 2
        smoother = Smoother(time, segment, highest)
        data.values["acceleration"] = smoother.smooth(data.values[origin], derivative)
        notes.append(f"acceleration in formulas: derived from {origin}, {filter_text(highest)}")
    return notes
