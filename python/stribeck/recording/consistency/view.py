"""What the checks look at: a recording, and how its columns were read."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.consistency.dissipation import Dissipation, dissipation
from stribeck.recording.consistency.follow import Follows, Track, follows
from stribeck.recording.consistency.readings import Source
from stribeck.recording.naming.names import same_of_joint
from stribeck.recording.recording import Recording
from stribeck.recording.tables.prepared import Prepared, columns_of

__all__ = ["View", "quoted"]


@dataclass(frozen=True)
class View:
    """A recording and the table it was read from.

    Attributes
    ----------
    recording
        With its channels in SI units.
    prepared
        The table, the choices of columns and the settings.
    rows
        Row of the table of each sample, [n].
    """

    recording: Recording
    prepared: Prepared
    rows: Ints

    @cached_property
    def track(self) -> Track:
        """The clock of the samples."""
        return Track(self.recording.time, self.recording.segment)

    def recorded(self, channel: str) -> Floats | None:
        """A channel that was read and not derived from another, [n]."""
        column = self.recording.columns.get(channel)
        if column is None or (column.derived and channel not in self.prepared.choices):
            return None
        values: Floats | None = getattr(self.recording, channel, None)
        return values

    @cached_property
    def velocity(self) -> Follows | None:
        """How the position follows the velocity; None where one of them was not recorded."""
        position, velocity = self.recorded("position"), self.recorded("velocity")
        if position is None or velocity is None or self.recording.averaged:
            return None
        return follows(self.track, position, velocity)

    @cached_property
    def acceleration(self) -> Follows | None:
        """How the velocity follows the acceleration; None where that was not recorded."""
        acceleration = self.recorded("acceleration")
        if acceleration is None or self.recording.averaged:
            return None
        return follows(self.track, self.recording.velocity, acceleration)

    @cached_property
    def dissipation(self) -> Dissipation | None:
        """What the torque has in common with the motion."""
        return dissipation(self.recording)

    def column(self, channel: str) -> str:
        """The column of the file that a channel is read from."""
        choice = self.prepared.choices.get(channel)
        return channel if choice is None else choice.source

    def columns_of(self, channel: str) -> tuple[str, ...]:
        """The columns of the file that a channel is read or computed from."""
        return columns_of(self.prepared, channel)

    def of_other_joints(self, column: str) -> dict[str, str]:
        """Joint -> column of the same name but for the number of the joint.

        Empty where one of them is a channel of this joint: then the numbers are those of the
        columns of a matrix.
        """
        found = same_of_joint(self.prepared.table.columns, column)
        own = {name for channel in self.prepared.choices for name in self.columns_of(channel)}
        return {} if own & set(found.values()) else found

    def replaced(self, channel: str, column: str, other: str) -> str:
        """The option that reads a channel from another column in place of `column`."""
        choice = self.prepared.choices[channel]
        formula = self.prepared.settings.derive.get(choice.source)
        if formula is not None:
            formula = re.sub(rf"(?<!\w){re.escape(column)}(?!\w)", other, formula)
            return option("derive", f"{choice.source}={formula}")
        return option("map", f"{choice.channel}={other}")

    def source(self, channel: str) -> Source:
        """How a channel is read."""
        choice = self.prepared.choices[channel]
        unit = choice.unit
        return Source(
            choice.source,
            1.0 if unit is None else unit.factor,
            None if unit is None else unit.dimension,
            choice.unit_from,
        )

    @cached_property
    def whole_clock(self) -> bool:
        """Whether every time stamp is a whole number of the file's unit."""
        stamps = self.recording.time / self.source("time").factor
        return bool(np.all(np.abs(stamps - np.round(stamps)) < 1e-6))

    def derived(self, channel: str, form: str) -> str:
        """The option that computes a channel by a formula; ``{}`` in `form` is how it is read now.

        A formula has no unit, so the unit of the column is given with it.
        """
        column = self.column(channel)
        formula = self.prepared.settings.derive.get(column)
        inner = f"({formula})" if formula is not None else quoted(column)
        given = option("derive", f"{channel}={form.format(inner)}")
        choice = self.prepared.choices[channel]
        if choice.unit is not None and choice.unit.factor != 1.0 and formula is None:
            given += " and " + option("unit", f"{channel}={choice.unit.name}")
        return given


def quoted(column: str) -> str:
    """A column's name as a formula takes it."""
    return column if column.isidentifier() else f"`{column}`"
