"""The channels of one joint while they are checked and completed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.base.errors import RecordingError
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.check import Check
from stribeck.recording.recording import Column
from stribeck.recording.tables.prepared import Prepared, channel_values

__all__ = ["MEASURED", "Channels", "Layout", "wanted_channels"]

#: What a logger reads from a joint and its drive.
MEASURED = ("position", "velocity", "torque", "current", "friction_torque")


class Channels:
    """The channels of one joint, SI units, arrays [n].

    Attributes
    ----------
    values, units, columns
        By channel; a unit is empty where none was named.
    notes
        How the columns were understood.
    rows
        Rows of the prepared table that the values are taken from, [n].
    sequence
        Row of the file of each sample, [n], not counting the rows without which time goes on.
    doubts
        Checks that fail before the recording is complete.
    """

    def __init__(self, prepared: Prepared, rows: Ints) -> None:
        self.prepared = prepared
        self.path = prepared.source.path
        self.values: dict[str, Floats] = {}
        self.units: dict[str, str] = {}
        self.columns: dict[str, Column] = {}
        self.notes: list[str] = list(prepared.notes)
        self.rows = rows
        self.sequence = prepared.row[rows]
        self.doubts: list[Check] = []

    @property
    def measured(self) -> dict[str, Floats]:
        """The channels that were measured, arrays [n]."""
        return {c: self.values[c] for c in MEASURED if c in self.values}

    def load(self, channel: str) -> None:
        """Read a channel and convert it to SI."""
        values, unit, _ = channel_values(self.prepared, channel, self.rows)
        self.values[channel] = values
        self.units[channel] = unit
        choice = self.prepared.choices[channel]
        if choice.unit is None or choice.unit.name == unit:
            return
        if choice.unit_from == "suffix":
            self.notes.append(
                f"{channel} is read from '{choice.source}' in {choice.unit.name}, converted to "
                f"{unit}"
            )
        elif choice.unit_from == "option":
            self.notes.append(
                f"'{choice.source}' is in {choice.unit.name} as given, converted to {unit}"
            )

    def keep(self, mask: Bools) -> None:
        """Remove the samples where `mask` is false."""
        self.rows, self.sequence = self.rows[mask], self.sequence[mask]
        self.values = {name: values[mask] for name, values in self.values.items()}

    def join(self, mask: Bools) -> None:
        """Remove the samples where `mask` is false, without a gap in their place."""
        self.sequence = self.sequence - np.cumsum(~mask)
        self.keep(mask)

    def reorder(self, order: Ints) -> None:
        """Put the samples in another order."""
        self.rows, self.sequence = self.rows[order], self.sequence[order]
        self.values = {name: values[order] for name, values in self.values.items()}

    def drop_empty(self) -> None:
        """Leave out optional channels without a single number.

        Raises
        ------
        RecordingError
            Neither velocity nor position is left.
        """
        for channel in ("position", "velocity", "acceleration", "temperature", "load_torque"):
            values = self.values.get(channel)
            if values is None or np.isfinite(values).any():
                continue
            other = {"velocity": "position", "position": "velocity"}.get(channel)
            if other is None or other in self.values:
                del self.values[channel]
                source = self.prepared.choices[channel].source
                self.notes.append(f"{channel} ('{source}') is empty and left out")
        if "velocity" not in self.values and "position" not in self.values:
            raise RecordingError(f"{self.path}: velocity and position hold no numbers")

    def place(self, sample: int) -> str:
        """Name the row of the file that a sample is taken from."""
        return self.prepared.source.place(int(self.prepared.row[self.rows[sample]]))


@dataclass(frozen=True)
class Layout:
    """Joint, units and runs of the channels.

    Attributes
    ----------
    run
        Number of the run of each sample, [n], runs contiguous.
    rows_dropped
        Samples removed for missing values.
    """

    joint: str | None
    joint_kind: str
    torque_unit: str
    position_unit: str
    run: Ints
    run_names: tuple[str, ...]
    rows_dropped: int


def wanted_channels(prepared: Prepared) -> list[str]:
    """Channels of the table that a recording is made of."""
    have = prepared.choices
    motion = ("time", "position", "velocity", "acceleration", "temperature")
    wanted: list[str] = [c for c in motion if c in have]
    # Friction measured directly replaces torque and load. Where a file has all three and no
    # option decides, the torque was measured and the friction computed from it.
    direct = "friction_torque" in have and (
        "friction_torque" in prepared.settings.maps
        or not ("torque" in have and "load_torque" in have)
    )
    if "external_torque" in have:
        wanted.append("external_torque")
    if prepared.settings.drive is not None and "enabled" in have:
        wanted.append("enabled")
    if direct:
        wanted.append("friction_torque")
    elif "torque" in have:
        wanted.append("torque")
    elif "current" in have:
        wanted.append("current")
    # Friction may depend on the load, so a recorded load is read in any case.
    if "load_torque" in have:
        wanted.append("load_torque")
    return wanted
