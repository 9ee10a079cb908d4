"""A file with derived columns, condition and column choices applied; it still has every joint."""

from __future__ import annotations

from stribeck.recording.naming.columns import choose_columns
from stribeck.recording.stated.settings import Settings
from stribeck.recording.tables.computed import apply_formulas
from stribeck.recording.tables.prepared import (
    Prepared,
    channel_values,
    columns_of,
    joint_rows,
    joints_of,
)
from stribeck.recording.tables.readers import Source, read_table
from stribeck.recording.weights import table_weights
from stribeck.recording.whole_file.derived_columns import Whole, wide_index

__all__ = [
    "Prepared",
    "channel_values",
    "columns_of",
    "joint_rows",
    "joints_of",
    "prepare",
    "prepared_table",
]


def prepare(path: str, settings: Settings) -> Prepared:
    """Read a file, apply formulas and condition, and choose its columns."""
    return prepared_table(read_table(path, settings.asked), settings)


def prepared_table(source: Source, settings: Settings) -> Prepared:
    """Apply formulas and condition to a table, and choose its columns."""
    computed = apply_formulas(source, settings, Whole(source, settings))
    choices, notes = choose_columns(
        source.path,
        computed.table.columns,
        derived=tuple(settings.derive),
        maps=settings.maps,
        units=computed.units,
        index=wide_index(source, computed.table, settings),
    )
    weight = None
    if settings.weights is not None:
        weight = table_weights(source, computed.table, computed.row, settings.weights)
    return Prepared(
        source,
        settings,
        computed.table,
        computed.row,
        choices,
        (*source.notes, *computed.notes, *notes),
        weight,
    )
