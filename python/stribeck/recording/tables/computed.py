"""Columns computed by formulas, and the rows that a condition keeps."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError, option
from stribeck.recording.arrays import Bools, Floats, Ints, floats
from stribeck.recording.naming.names import file_unit, parse_name
from stribeck.recording.stated.settings import Settings
from stribeck.recording.tables.cells import column_numbers
from stribeck.recording.tables.column_functions import Over
from stribeck.recording.tables.formula import ROW, Formula, channel_column, compile_formula
from stribeck.recording.tables.readers import Source

__all__ = ["Computed", "View", "apply_formulas", "column_of"]


class View(Protocol):
    """A whole table: what formulas see of it besides the columns."""

    def over(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> Over:
        """Functions of all samples, which state their filters in `notes`."""

    def channels(
        self, table: pl.DataFrame, names: tuple[str, ...], where: str, notes: list[str]
    ) -> Mapping[str, Floats]:
        """Channels that are no columns, in SI units, [rows] each."""


@dataclass(frozen=True)
class Computed:
    """A table with its derived columns.

    Attributes
    ----------
    table
        The rows that are kept.
    row
        Their row numbers in the file, from 0.
    units
        Column -> unit: those that were given, and those that follow from a formula.
    """

    table: pl.DataFrame
    row: Ints
    units: dict[str, str]
    notes: tuple[str, ...]


def apply_formulas(
    source: Source, settings: Settings, view: View | None, *, may_be_empty: bool = False
) -> Computed:
    """Add the derived columns and keep the rows for which `where` holds.

    Parameters
    ----------
    view
        None for a part of a table, where formulas see the columns of each row alone.

    Raises
    ------
    RecordingError
        A formula cannot be used, or no row is left and the table may not be empty.
    """
    table, units = source.table, dict(settings.units)
    notes: list[str] = []
    for name, text in settings.derive.items():
        where = f"{source.path}: {option('derive', f'{name}={text}')}"
        formula, seen = _seen(source, table, text, where, view, notes)
        expression = formula.expression
        if formula.kind == "truth":
            expression = expression.cast(pl.Float64)
        made = _run(where, seen.with_columns, expression.alias(name))
        table = made.drop(column for column in seen.columns if column not in table.columns)
        inferred = _inferred_unit(formula)
        effort = parse_name(name).channel in ("torque", "load_torque", "friction_torque")
        if effort and name not in units and inferred is not None:
            units[name] = inferred
            notes.append(f"'{name}' is in {inferred}, the unit of the columns in its formula")
    row = np.arange(table.height)
    if settings.where is not None:
        mask = _mask(source, table, settings.where, view, notes)
        if not (mask.any() or may_be_empty):
            raise RecordingError(
                f"{source.path}: {option('where', settings.where)} keeps none of {table.height} "
                "rows"
            )
        row = np.flatnonzero(mask)
        table = table.filter(pl.Series(mask))
    return Computed(table, row, units, tuple(notes))


def column_of(source: Source, table: pl.DataFrame, text: str, where: str) -> Floats:
    """The numbers of a column, or of a formula of columns, [rows]; NaN where a cell is empty.

    Parameters
    ----------
    where
        What the numbers are for; every error begins with it.
    """
    text = f"`{text}`" if text in table.columns else text
    formula, table = _seen(source, table, text, where, None, [])
    if formula.kind == "text":
        raise RecordingError(f"{where}: is a text, not a number")
    expression = formula.expression.cast(pl.Float64).alias("value")
    values = _run(where, table.select, expression)["value"].fill_null(math.nan).to_numpy()
    # A formula without a column has one value.
    return floats(values if values.size == table.height else np.full(table.height, values[0]))


def _mask(
    source: Source, table: pl.DataFrame, text: str, view: View | None, notes: list[str]
) -> Bools:
    """The rows for which a condition holds; a number holds unless it is zero."""
    where = f"{source.path}: {option('where', text)}"
    formula, table = _seen(source, table, text, where, view, notes)
    if formula.kind == "text":
        raise RecordingError(f"{where}: is a text, not a condition")
    condition = formula.expression if formula.kind == "truth" else formula.expression != 0.0
    mask: Bools = _run(where, table.select, condition.fill_null(False).alias("keep"))[
        "keep"
    ].to_numpy()
    # A condition without a column has one value.
    return mask if mask.shape[0] == table.height else np.full(table.height, bool(mask[0]))


def _inferred_unit(formula: Formula) -> str | None:
    """V or % if a formula only scales one column in that unit by powers of ten, otherwise None.

    ``pwm_permille/1000*supply_V`` is a voltage; ``u_V*35.15`` may be anything.
    """
    if not formula.product or not formula.columns:
        return None
    if any(
        n <= 0.0 or not math.isclose(math.log10(n) % 1.0, 0.0, abs_tol=1e-12)
        for n in formula.numbers
    ):
        return None
    units = [u for u in map(file_unit, formula.columns) if u is not None and u.name != "permille"]
    if len(units) == 1 and units[0].name in ("V", "%"):
        return units[0].name
    return None


def _seen(
    source: Source,
    table: pl.DataFrame,
    text: str,
    where: str,
    view: View | None,
    notes: list[str],
) -> tuple[Formula, pl.DataFrame]:
    """A formula, and the table with the channels in it that are no columns."""
    formula = _compile(source, table, text, where, None)
    counted = (ROW,) if formula.counts_rows else ()
    further = (*formula.over_all, *formula.channels, *counted)
    if not further:
        return formula, table
    if view is None:
        raise RecordingError(
            f"{where}: '{further[0]}' needs the whole recording, which is not at hand here: "
            f"compute a column first, with {option('derive', 'NAME=FORMULA')} of data that is not "
            "read in passes"
        )
    if formula.over_all:
        formula = _compile(
            source, table, text, where, view.over(table, formula.over_all, where, notes)
        )
    seen = view.channels(table, formula.channels, where, notes)
    # A missing value, not NaN, which would be larger than any number.
    columns = [
        pl.Series(channel_column(name), values).fill_nan(None) for name, values in seen.items()
    ]
    return formula, table.with_columns(columns)


def _compile(
    source: Source, table: pl.DataFrame, text: str, where: str, over: Over | None
) -> Formula:
    try:
        return compile_formula(text, table.schema, where, over, table.height)
    except RecordingError:
        # One bad cell makes a column of numbers a column of text: then the cell is refused.
        for name, dtype in table.schema.items():
            if dtype == pl.String and name in text:
                bare = table[name].str.strip_chars().drop_nulls()
                numbers = bare.cast(pl.Float64, strict=False).drop_nulls()
                if 2 * len(numbers) > len(bare):
                    column_numbers(source, table, np.arange(table.height), name)
        raise


def _run(
    where: str, compute: Callable[[pl.Expr], pl.DataFrame], expression: pl.Expr
) -> pl.DataFrame:
    try:
        return compute(expression)
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException) as error:
        reason = str(error).strip().splitlines()[0][:120]
        raise RecordingError(f"{where}: cannot be computed ({reason})") from None
