"""Formulas over columns: the formulas of friction laws, with conditions, texts and more functions.

The crate parses the text (`src/formula`), so that a formula means the same here and in a law;
polars evaluates it. Nothing of the text is executed as code.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, NoReturn

import numpy as np
import polars as pl

from stribeck import _core
from stribeck.base.errors import RecordingError, listed, nearest
from stribeck.recording.naming.names import CHANNELS
from stribeck.recording.tables.column_functions import (
    Over,
    choose,
    interpolated,
    of_all,
    table_problem,
)

__all__ = ["Formula", "channel_column", "compile_formula"]

_LIMIT = 2000

Kind = Literal["number", "text", "truth"]
#: What a step of `_core.column_formula` works on: a number, a text, a function and its number of
#: arguments, or nothing.
Detail = float | str | tuple[str, int] | None

#: ``g`` is the standard acceleration of gravity, m/s2.
#: The number of the row, from 0, where no column has this name.
ROW = "row"
_CONSTANTS = {"pi": 3.141592653589793, "e": 2.718281828459045, "g": 9.80665}
_TRUTHS = {"true": True, "True": True, "false": False, "False": False}
_ARITHMETIC: dict[str, Callable[[pl.Expr, pl.Expr], pl.Expr]] = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
    "divide": operator.truediv,
    "power": pl.Expr.pow,
}
_COMPARISONS: dict[str, Callable[[pl.Expr, pl.Expr], pl.Expr]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


def _expm1(x: pl.Expr) -> pl.Expr:
    return x.map_batches(np.expm1, return_dtype=pl.Float64)


#: What the crate's functions (`_core.formula_functions`) are in polars.
_FUNCTIONS: dict[str, Callable[..., pl.Expr]] = {
    "sgn": pl.Expr.sign,
    "abs": pl.Expr.abs,
    "exp": pl.Expr.exp,
    "expm1": _expm1,
    "log": pl.Expr.log,
    "log10": pl.Expr.log10,
    "sqrt": pl.Expr.sqrt,
    "cbrt": pl.Expr.cbrt,
    "sin": pl.Expr.sin,
    "cos": pl.Expr.cos,
    "tan": pl.Expr.tan,
    "atan": pl.Expr.arctan,
    "tanh": pl.Expr.tanh,
    "pow": pl.Expr.pow,
    "min": pl.min_horizontal,
    "max": pl.max_horizontal,
}


@dataclass(frozen=True)
class Formula:
    """A formula over the columns of a table.

    Attributes
    ----------
    kind
        What its values are.
    columns, numbers
        The columns and the numbers in it, in order.
    product
        Whether it only multiplies and divides: units of the one column then carry over.
    channels
        The channels in it that are no columns; each is the column `channel_column` of the table
        that the expression is evaluated on.
    over_all
        The functions in it that need all samples.
    counts_rows
        Whether it reads the number of the row.
    """

    text: str
    expression: pl.Expr
    kind: Kind
    columns: tuple[str, ...]
    numbers: tuple[float, ...]
    product: bool
    channels: tuple[str, ...] = ()
    over_all: tuple[str, ...] = ()
    counts_rows: bool = False


def channel_column(channel: str) -> str:
    """The name of the column that holds a channel while a formula is evaluated."""
    return f"<{channel}>"


def compile_formula(
    text: str,
    schema: Mapping[str, pl.DataType],
    where: str,
    over: Over | None = None,
    rows: int = 0,
) -> Formula:
    """Compile a formula over the columns of a table.

    Parameters
    ----------
    text
        The formula. A column whose name is not a plain word is written in back-ticks.
    schema
        Column names and types of the table.
    where
        What the formula is for; every error sentence begins with it.
    over, rows
        How functions of all samples are computed, and the rows of the table. Without them the
        formula can be looked at; if it has such functions, it cannot be evaluated.

    Raises
    ------
    RecordingError
        The text is no formula, or it does not fit the columns; with the position.
    """
    if len(text) > _LIMIT:
        raise RecordingError(f"{where}: the formula is longer than {_LIMIT} characters")
    try:
        steps = _core.column_formula(text)
    except _core.ModelError as error:
        # Only an empty formula has no position.
        of = f" of '{text}'" if text.strip() else ""
        raise RecordingError(f"{where}: {error}{of}") from None
    compiler = _Compiler(text, schema, where, over, rows)
    for name, detail, position in steps:
        compiler.step(name, detail, position)
    (value,) = compiler.stack
    numbers = tuple(compiler.numbers)
    return Formula(
        text,
        value.expression,
        value.kind,
        tuple(compiler.columns),
        numbers,
        compiler.product,
        tuple(compiler.channels),
        tuple(compiler.over_all),
        compiler.counts_rows,
    )


@dataclass(frozen=True)
class _Value:
    """A value on the stack.

    Attributes
    ----------
    position
        Of its first character, counted from 1.
    last
        The right operand, where it is a comparison.
    constant
        Its number, where it is one.
    """

    expression: pl.Expr
    kind: Kind
    position: int
    last: _Value | None = None
    constant: float | None = None


class _Compiler:
    """The stack while the steps of a formula are taken."""

    def __init__(
        self,
        text: str,
        schema: Mapping[str, pl.DataType],
        where: str,
        over: Over | None,
        rows: int,
    ) -> None:
        self.text = text
        self.schema = schema
        self.where = where
        self.over = over
        self.rows = rows
        self.stack: list[_Value] = []
        self.columns: list[str] = []
        self.channels: list[str] = []
        self.over_all: list[str] = []
        self.counts_rows = False
        self.numbers: list[float] = []
        self.product = True

    def step(self, name: str, detail: Detail, position: int) -> None:
        """Take one step of `_core.column_formula`."""
        if isinstance(detail, float):
            self.numbers.append(detail)
            literal = pl.lit(detail, dtype=pl.Float64)
            self.stack.append(_Value(literal, "number", position, constant=detail))
        elif isinstance(detail, tuple):
            self._call(detail[0], detail[1], position)
        elif name == "text" and detail is not None:
            self.stack.append(_Value(pl.lit(ast.literal_eval(detail)), "text", position))
        elif name == "name" and detail is not None:
            self._name(detail, position)
        elif detail is not None:
            self._compare(detail, chained=name == "chain")
        elif name == "negate":
            value = self.stack.pop()
            negated = None if value.constant is None else -value.constant
            expression = -self._number(value)
            self.stack.append(_Value(expression, "number", position, constant=negated))
        elif name == "not":
            expression = ~self._truth(self.stack.pop())
            self.stack.append(_Value(expression, "truth", position))
        elif name in ("and", "or"):
            self._join(name)
        else:
            self._binary(name)

    def _refuse(self, message: str, position: int) -> NoReturn:
        raise RecordingError(f"{self.where}: {message} at position {position} of '{self.text}'")

    def _number(self, value: _Value) -> pl.Expr:
        if value.kind == "text":
            self._refuse("text is used as a number", value.position)
        truth = value.kind == "truth"
        return value.expression.cast(pl.Float64) if truth else value.expression

    def _truth(self, value: _Value) -> pl.Expr:
        if value.kind == "text":
            self._refuse("text is used as a condition", value.position)
        return value.expression if value.kind == "truth" else value.expression != 0.0

    def _name(self, name: str, position: int) -> None:
        """A column by its name in any case; otherwise a constant or a channel."""
        if name not in self.schema:
            folded = [column for column in self.schema if column.casefold() == name.casefold()]
            if len(folded) != 1:
                self.stack.append(self._no_column(name, position))
                return
            name = folded[0]
        if name not in self.columns:
            self.columns.append(name)
        dtype, column = self.schema[name], pl.col(name)
        if dtype == pl.Boolean:
            self.stack.append(_Value(column, "truth", position))
        elif dtype.is_numeric():
            self.stack.append(_Value(column.cast(pl.Float64), "number", position))
        elif dtype in (pl.String, pl.Categorical, pl.Enum) or dtype.is_temporal():
            self.stack.append(_Value(column.cast(pl.String), "text", position))
        else:
            self._refuse(f"column '{name}' holds neither numbers nor text", position)

    def _no_column(self, name: str, position: int) -> _Value:
        """A name that is no column: a constant or a channel."""
        if name in _CONSTANTS:
            number = _CONSTANTS[name]
            self.numbers.append(number)
            return _Value(pl.lit(number), "number", position, constant=number)
        if name in _TRUTHS:
            return _Value(pl.lit(_TRUTHS[name]), "truth", position)
        if name == ROW:
            self.counts_rows = True
            count = pl.int_range(0, pl.len()).cast(pl.Float64)
            return _Value(count, "number", position)
        if CHANNELS.get(name):
            if name not in self.channels:
                self.channels.append(name)
            return _Value(pl.col(channel_column(name)), "number", position)
        hint = nearest(name, self.schema) or f"; the file has {listed(self.schema)}"
        found = f"it is at position {position} of '{self.text}'"
        end = f" ({found})" if hint.endswith("?") else f"; {found}"
        raise RecordingError(f"{self.where}: unknown column '{name}'{hint}{end}")

    def _binary(self, name: str) -> None:
        right, left = self.stack.pop(), self.stack.pop()
        if name not in ("multiply", "divide"):
            self.product = False
        expression = _ARITHMETIC[name](self._number(left), self._number(right))
        self.stack.append(_Value(expression, "number", left.position))

    def _join(self, name: str) -> None:
        self.product = False
        right, left = self.stack.pop(), self.stack.pop()
        one, other = self._truth(left), self._truth(right)
        expression = one & other if name == "and" else one | other
        self.stack.append(_Value(expression, "truth", left.position))

    def _compare(self, comparison: str, *, chained: bool) -> None:
        """A comparison; in ``a < b < c`` the second one is of b and c, and both must hold."""
        self.product = False
        right, before = self.stack.pop(), self.stack.pop()
        left = before.last if chained and before.last is not None else before
        if (left.kind == "text") != (right.kind == "text"):
            self._refuse("text is compared with a number (texts are in quotes)", right.position)
        one, other = left.expression, right.expression
        if left.kind != right.kind:
            one, other = one.cast(pl.Float64), other.cast(pl.Float64)
        expression = _COMPARISONS[comparison](one, other)
        if chained:
            expression = before.expression & expression
        self.stack.append(_Value(expression, "truth", before.position, last=right))

    def _call(self, name: str, given: int, position: int) -> None:
        self.product = False
        values = self.stack[-given:]
        del self.stack[-given:]
        if name == "where":
            condition = self._truth(values[0])
            expression = choose(condition, *(self._number(value) for value in values[1:]))
        elif name == "interp":
            points = [value.constant for value in values[1:]]
            problem = table_problem(points)
            if problem is not None:
                self._refuse(problem, position)
            x = self._number(values[0])
            expression = interpolated(x, [n for n in points if n is not None])
        elif name in ("diff", "mean"):
            if name not in self.over_all:
                self.over_all.append(name)
            expression = self._number(values[0])
            if self.over is not None:
                expression = of_all(getattr(self.over, name), self.rows)(expression)
        else:
            expression = _FUNCTIONS[name](*(self._number(value) for value in values))
        self.stack.append(_Value(expression, "number", position))
