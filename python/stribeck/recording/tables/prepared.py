"""A table with every joint of a file: its joints, and the channels of one in SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError, listed, nearest, option
from stribeck.base.units import SI
from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.naming.columns import Choice
from stribeck.recording.naming.names import wide_groups
from stribeck.recording.stated.settings import Settings
from stribeck.recording.tables.cells import column_numbers, labels
from stribeck.recording.tables.formula import compile_formula
from stribeck.recording.tables.readers import Source

__all__ = ["Prepared", "channel_values", "columns_of", "joint_rows", "joints_of"]


@dataclass(frozen=True)
class Prepared:
    """A table with every joint of a file.

    Attributes
    ----------
    table
        Rows that passed `where`.
    row
        Their row numbers in the file, from 0.
    choices
        Channel -> column of the file.
    weight
        Weight of each row of `table`, where weights are given.
    """

    source: Source
    settings: Settings
    table: pl.DataFrame
    row: Ints
    choices: dict[str, Choice]
    notes: tuple[str, ...]
    weight: Floats | None = None

    @property
    def derived(self) -> tuple[str, ...]:
        """Columns computed by a formula."""
        return tuple(self.settings.derive)

    @property
    def rows_removed(self) -> int:
        """Rows for which `where` does not hold."""
        return self.source.table.height - self.table.height


def columns_of(prepared: Prepared, channel: str) -> tuple[str, ...]:
    """The columns of the file that a channel is read or computed from; empty without it."""
    choice = prepared.choices.get(channel)
    if choice is None:
        return ()
    text = prepared.settings.derive.get(choice.source)
    if text is None:
        return (choice.source,)
    formula = compile_formula(text, prepared.table.schema, text)
    # A velocity or acceleration that is no column is derived from the position.
    motion = {"velocity", "acceleration"} & set(formula.channels)
    names = [*formula.channels, *(["position"] if motion else [])]
    chosen = [prepared.choices[name].source for name in names if name in prepared.choices]
    read = [source for source in chosen if source not in prepared.settings.derive]
    return tuple(dict.fromkeys([*formula.columns, *read]))


def joints_of(prepared: Prepared) -> list[str]:
    """The joints of a file in order of appearance; empty without a joint column."""
    choice = prepared.choices.get("joint")
    if choice is None:
        return []
    return labels(prepared.table, choice.source).unique(maintain_order=True).to_list()


def joint_rows(prepared: Prepared, joint: str | None) -> tuple[str | None, Ints]:
    """The joint to read, and its rows.

    Raises
    ------
    RecordingError
        The file has several joints and none, or an unknown one, was named.
    """
    path = prepared.source.path
    joints = joints_of(prepared)
    everything = np.arange(prepared.table.height)
    if not joints:
        named = wide_groups(prepared.table.columns) or joint in prepared.source.joints
        if joint is not None and not named:
            raise RecordingError(
                f"{path}: there is no joint column to find '{joint}' in: leave out "
                f"{option('joint')}, or name the column with {option('map', 'joint=COLUMN')}"
            )
        return joint, everything
    if joint is None:
        if len(joints) == 1:
            return joints[0], everything
        raise RecordingError(
            f"{path}: holds {len(joints)} joints: name one with {option('joint')} "
            f"({_listed(joints)})"
        )
    if joint not in joints:
        hint = nearest(joint, joints)
        raise RecordingError(
            f"{path}: there is no joint '{joint}'{hint or '; there are ' + _listed(joints)}"
        )
    names = labels(prepared.table, prepared.choices["joint"].source)
    return joint, np.flatnonzero(names == joint)


def _listed(names: list[str]) -> str:
    """Names as they are typed; a name may be empty."""
    return listed(name or "''" for name in names)


def channel_values(prepared: Prepared, channel: str, rows: Ints) -> tuple[Floats, str, str]:
    """A channel of some rows (ascending) in SI, its unit ('' if not named) and dimension."""
    choice = prepared.choices[channel]
    table, row = prepared.table.select(choice.source), prepared.row
    if rows.size < table.height:
        table, row = table[rows], row[rows]
    values = column_numbers(prepared.source, table, row, choice.source)
    if choice.unit is None:
        return values, "", ""
    unit = choice.unit
    if unit.factor != 1.0 or unit.offset != 0.0:
        values = values * unit.factor + unit.offset
    return values, SI[unit.dimension], unit.dimension
