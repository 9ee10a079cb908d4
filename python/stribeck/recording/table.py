"""A file with the user's formulas, filter and column choices applied; still every joint of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, nearest
from stribeck.recording.columns import Choice, choose_columns, file_unit, parse_name, wide_groups
from stribeck.recording.formula import Formula, compile_formula
from stribeck.recording.options import Options
from stribeck.recording.readers import Source, read_table
from stribeck.recording.units import SI

__all__ = [
    "Prepared", "channel_values", "joint_rows", "joints_of", "labels", "prepare", "prepared_table",
]  # fmt: skip

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Prepared:
    """A table ready to be cut into joints.

    Attributes
    ----------
    table
        Rows that passed `where`.
    row
        Their row numbers in the file, from 0.
    choices
        Channel -> column of the file.
    derived
        Columns that a formula made.
    """

    source: Source
    options: Options
    table: pl.DataFrame
    row: Ints
    choices: dict[str, Choice]
    derived: tuple[str, ...]
    rows_removed: int
    notes: tuple[str, ...]


def _inferred_unit(formula: Formula) -> str | None:
    """Return V or % when a formula only scales one column in that unit by powers of ten.

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


def apply_formulas(
    source: Source, options: Options, *, all_may_go: bool = False
) -> tuple[pl.DataFrame, Ints, tuple[str, ...], dict[str, str], list[str]]:
    """Add the derived columns and remove the rows that `where` leaves out.

    Unless `all_may_go`, some row has to be left.
    """
    path = source.path
    table = source.table
    units = dict(options.units)
    notes: list[str] = []
    for name, text in options.derive.items():
        formula = _compile(source, table, text, f"{path}: --derive {name}")
        expression = formula.expression
        if formula.kind == "truth":
            expression = expression.cast(pl.Float64)
        table = _run(path, f"--derive {name}={text}", table.with_columns, expression.alias(name))
        inferred = _inferred_unit(formula)
        channel = parse_name(name).channel
        effort = channel in ("torque", "load_torque", "friction_torque")
        if effort and name not in units and inferred is not None:
            units[name] = inferred
            notes.append(f"'{name}' is in {inferred}, the unit of the columns in its formula")
    row = np.arange(table.height)
    if options.where is not None:
        formula = _compile(source, table, options.where, f"{path}: --where")
        if formula.kind == "text":
            raise RecordingError(f"{path}: --where {options.where}: is a text, not a condition")
        mask_expression = (
            formula.expression if formula.kind == "truth" else formula.expression != 0.0
        )
        keep = mask_expression.fill_null(False).alias("keep")
        mask = _run(path, f"--where {options.where}", table.select, keep)["keep"].to_numpy()
        if mask.shape[0] != table.height:
            mask = np.full(table.height, bool(mask[0]))
        if not (mask.any() or all_may_go):
            raise RecordingError(
                f"{path}: --where {options.where}: leaves no rows of {table.height}"
            )
        row = np.flatnonzero(mask)
        table = table.filter(pl.Series(mask))
    return table, row, tuple(options.derive), units, notes


def prepare(path: str, options: Options) -> Prepared:
    """Read a file and apply formulas, filter and column choices."""
    return prepared_table(read_table(path), options)


def prepared_table(source: Source, options: Options) -> Prepared:
    """Apply formulas, filter and column choices to a table."""
    table, row, derived, units, notes = apply_formulas(source, options)
    choices, more = choose_columns(
        source.path,
        table.columns,
        derived=derived,
        maps=options.maps,
        units=units,
        index=_wide_index(table, options),
    )
    return Prepared(
        source, options, table, row, choices, derived, source.table.height - table.height,
        (*notes, *more),
    )  # fmt: skip


def _wide_index(table: pl.DataFrame, options: Options) -> str | None:
    """Return the joint of a wide file when --joint names one and there is no joint column."""
    if options.joint is None or "joint" in options.maps or "joint" in options.derive:
        return None
    if any(parse_name(name).channel == "joint" for name in table.columns):
        return None
    return options.joint.removeprefix("joint_").removeprefix("joint")


def _compile(source: Source, table: pl.DataFrame, text: str, where: str) -> Formula:
    try:
        return compile_formula(text, table.schema, where)
    except RecordingError:
        # One bad cell turns a column of numbers into text: then the cell is what is wrong.
        for name in table.columns:
            if table.schema[name] == pl.String and name in text:
                bare = table[name].str.strip_chars().drop_nulls()
                numbers = bare.cast(pl.Float64, strict=False).drop_nulls()
                if 2 * len(numbers) > len(bare):
                    column_numbers(source, table, np.arange(table.height), name)
        raise


def _run(
    path: str, what: str, compute: Callable[[pl.Expr], pl.DataFrame], expression: pl.Expr
) -> pl.DataFrame:
    try:
        return compute(expression)
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException) as error:
        reason = str(error).strip().splitlines()[0][:120]
        raise RecordingError(f"{path}: {what}: cannot be computed ({reason})") from None


# -------------------------------------------------------------------------------------- values


def labels(table: pl.DataFrame, column: str) -> pl.Series:
    """Return the names of the joints or runs of each row, whole numbers without a decimal point."""
    series = table[column]
    if series.dtype.is_float():
        values = series.unique()
        return series.replace_strict(values, list(map(_label, values)), return_dtype=pl.String)
    return series.cast(pl.String).fill_null("")


def _label(value: float | None) -> str:
    if value is None:
        return ""
    return str(int(value)) if value.is_integer() else str(value)


def numbered(names: pl.Series) -> tuple[list[str], Ints]:
    """Return the different names in order of appearance, and which of them stands in each row."""
    different = names.unique(maintain_order=True)
    number = np.arange(len(different), dtype=np.int64)
    return different.to_list(), names.replace_strict(different, number).to_numpy()


def joints_of(prepared: Prepared) -> list[str]:
    """Return the joints of a file in order of appearance; empty without a joint column."""
    choice = prepared.choices.get("joint")
    if choice is None:
        return []
    return labels(prepared.table, choice.source).unique(maintain_order=True).to_list()


def joint_rows(prepared: Prepared, joint: str | None) -> tuple[str | None, Ints]:
    """Return the joint to read and its rows.

    Raises
    ------
    RecordingError
        When the file holds several joints and none, or an unknown one, was named.
    """
    path = prepared.source.path
    joints = joints_of(prepared)
    everything = np.arange(prepared.table.height)
    if not joints:
        if joint is not None and not wide_groups(prepared.table.columns):
            raise RecordingError(
                f"{path}: there is no joint column to find '{joint}' in: leave --joint out, or say "
                "which with --map joint=COLUMN"
            )
        return joint, everything
    if joint is None:
        if len(joints) == 1:
            return joints[0], everything
        raise RecordingError(
            f"{path}: holds {len(joints)} joints: name one with --joint ({_listed(joints)})"
        )
    if joint not in joints:
        hint = nearest(joint, joints)
        raise RecordingError(
            f"{path}: there is no joint '{joint}'{hint or '; there are ' + _listed(joints)}"
        )
    names = labels(prepared.table, prepared.choices["joint"].source)
    return joint, np.flatnonzero(names == joint)


def _listed(names: list[str]) -> str:
    """Names as they are typed; rows may have none."""
    return ", ".join(name or "''" for name in names)


def column_numbers(source: Source, table: pl.DataFrame, row: Ints, column: str) -> Floats:
    """Return a column as numbers, NaN where a cell is empty.

    Raises
    ------
    RecordingError
        When a cell holds text, naming file, row and column.
    """
    series = table[column]
    dtype = series.dtype
    if dtype == pl.String:
        bare = series.str.strip_chars()
        numbers = bare.cast(pl.Float64, strict=False)
        bad = (numbers.is_null() & bare.is_not_null() & (bare != "")).fill_null(False)
        if bad.any():
            first = int(bad.arg_true()[0])
            raise RecordingError(
                f"{source.path}: {source.place(int(row[first]))}, column '{column}': "
                f"'{str(series[first])[:40]}' is not a number: correct or remove that row"
            )
        series = numbers
    elif dtype.is_temporal():
        if dtype == pl.Date or dtype == pl.Time:
            raise RecordingError(
                f"{source.path}: column '{column}' holds {dtype} values, numbers are needed: "
                "give seconds"
            )
        if dtype == pl.Duration:
            series = series.dt.total_nanoseconds().cast(pl.Float64) * 1e-9
        else:
            # Seconds since the first row: a date in seconds would lose microseconds in rounding.
            series = (series - series.drop_nulls()[0]).dt.total_nanoseconds().cast(
                pl.Float64
            ) * 1e-9
    elif not (dtype.is_numeric() or dtype == pl.Boolean):
        raise RecordingError(
            f"{source.path}: column '{column}' holds {dtype} values, numbers are needed"
        )
    values = series.cast(pl.Float64).fill_null(float("nan")).to_numpy()
    return np.array(values, dtype=np.float64)


def channel_values(prepared: Prepared, channel: str, rows: Ints) -> tuple[Floats, str, str]:
    """Return a channel of some rows, ascending, in SI, its SI unit (or '' when none was named) and
    dimension.
    """
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
