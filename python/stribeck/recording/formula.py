"""A small, safe formula language over columns: parsed by Python's grammar, run by polars.

Nothing is ever executed as Python. Only the node types listed here are translated; everything else
is refused with its position.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NoReturn

import polars as pl

from stribeck.base.errors import RecordingError, nearest

__all__ = ["Formula", "compile_formula"]

_LIMIT = 2000

_FUNCTIONS = ("abs", "sqrt", "exp", "log", "sin", "cos", "tan", "sign", "min", "max")
_WORDS = {"pi": 3.141592653589793, "e": 2.718281828459045}


@dataclass(frozen=True)
class Formula:
    """A translated formula: its expression, its kind and the columns it reads."""

    text: str
    expression: pl.Expr
    kind: str  # "number" | "text" | "truth"
    columns: tuple[str, ...]
    numbers: tuple[float, ...]
    product: bool  # only *, / and numbers between columns: units of the one column carry over


def compile_formula(text: str, schema: Mapping[str, pl.DataType], where: str) -> Formula:
    """Translate a formula over the columns of a table.

    Parameters
    ----------
    text
        The formula. A column whose name is not a plain word goes in back-ticks.
    schema
        Column names and types of the table.
    where
        What the formula is for, the start of every error sentence.
    """
    if len(text) > _LIMIT:
        raise RecordingError(f"{where}: the formula is longer than {_LIMIT} characters")
    if not text.strip():
        raise RecordingError(f"{where}: the formula is empty")
    quoted: dict[str, str] = {}

    def hide(match: re.Match[str]) -> str:
        # Same length as the original, so that positions in error sentences stay right.
        width = len(match.group(0))
        name = f"_{len(quoted)}_".ljust(width, "_") if width >= 4 else f"_{len(quoted)}"
        quoted[name] = match.group(1)
        return name

    plain = re.sub(r"`([^`]+)`", hide, text)
    # Leading blanks would be an indentation error; columns are counted back in below.
    stripped = plain.lstrip()
    shift = len(plain) - len(stripped)
    stripped = stripped.rstrip()
    try:
        tree = ast.parse(stripped, mode="eval")
    except SyntaxError as error:
        position = (error.offset or len(stripped) + 1) + shift
        hint = ""
        if re.search(r"(?<![=!<>])=(?!=)", plain):
            hint = " (equality is written ==)"
        elif "&&" in plain or "||" in plain:
            hint = " (write 'and', 'or')"
        raise RecordingError(
            f"{where}: '{text}' is not a formula, at position {position}{hint}"
        ) from None
    except (ValueError, RecursionError, MemoryError):
        raise RecordingError(f"{where}: '{text[:80]}' is not a formula") from None
    try:
        return _Translator(text, schema, where, quoted, shift).run(tree)
    except RecursionError:
        raise RecordingError(f"{where}: the formula is nested too deeply") from None


class _Translator:
    def __init__(
        self,
        text: str,
        schema: Mapping[str, pl.DataType],
        where: str,
        quoted: dict[str, str],
        shift: int,
    ) -> None:
        self.text = text
        self.schema = schema
        self.where = where
        self.quoted = quoted
        self.shift = shift
        self.columns: list[str] = []
        self.numbers: list[float] = []
        self.product = True

    def run(self, tree: ast.Expression) -> Formula:
        expression, kind = self.visit(tree.body)
        return Formula(
            self.text, expression, kind, tuple(self.columns), tuple(self.numbers), self.product
        )

    def refuse(self, node: ast.AST, message: str) -> NoReturn:
        position = getattr(node, "col_offset", 0) + 1 + self.shift
        raise RecordingError(f"{self.where}: {message} at position {position} of '{self.text}'")

    def number(self, node: ast.AST) -> pl.Expr:
        expression, kind = self.visit(node)
        if kind == "text":
            self.refuse(node, "text is used as a number")
        return expression.cast(pl.Float64) if kind == "truth" else expression

    def truth(self, node: ast.AST) -> pl.Expr:
        expression, kind = self.visit(node)
        if kind == "text":
            self.refuse(node, "text is used as true or false")
        return expression if kind == "truth" else expression != 0.0

    def visit(self, node: ast.AST) -> tuple[pl.Expr, str]:
        if isinstance(node, ast.Constant):
            return self.constant(node)
        if isinstance(node, ast.Name):
            return self.name(node)
        if isinstance(node, ast.BinOp):
            return self.binary(node), "number"
        if isinstance(node, ast.UnaryOp):
            if isinstance(node.op, ast.Not):
                return ~self.truth(node.operand), "truth"
            if isinstance(node.op, ast.USub):
                return -self.number(node.operand), "number"
            if isinstance(node.op, ast.UAdd):
                return self.number(node.operand), "number"
            self.refuse(node, "the operator '~' is not available (write 'not')")
        if isinstance(node, ast.BoolOp):
            self.product = False
            parts = [self.truth(value) for value in node.values]
            joined = parts[0]
            for part in parts[1:]:
                joined = joined & part if isinstance(node.op, ast.And) else joined | part
            return joined, "truth"
        if isinstance(node, ast.Compare):
            return self.compare(node), "truth"
        if isinstance(node, ast.Call):
            return self.call(node), "number"
        self.refuse(
            node,
            "only numbers, texts, columns, + - * / **, comparisons, and/or/not and "
            f"{', '.join(_FUNCTIONS)} are available, not what stands",
        )

    def constant(self, node: ast.Constant) -> tuple[pl.Expr, str]:
        value = node.value
        if isinstance(value, bool):
            return pl.lit(value), "truth"
        if isinstance(value, (int, float)):
            try:
                number = float(value)
            except OverflowError:
                self.refuse(node, "a number is too large")
            self.numbers.append(number)
            return pl.lit(number, dtype=pl.Float64), "number"
        if isinstance(value, str):
            return pl.lit(value), "text"
        self.refuse(node, "this kind of value is not available")

    def name(self, node: ast.Name) -> tuple[pl.Expr, str]:
        name = self.quoted.get(node.id, node.id)
        if name not in self.schema:
            folded = [column for column in self.schema if column.casefold() == name.casefold()]
            if len(folded) == 1:
                name = folded[0]
            elif name in _WORDS:
                self.numbers.append(_WORDS[name])
                return pl.lit(_WORDS[name]), "number"
            elif name in ("true", "false"):
                return pl.lit(name == "true"), "truth"
            else:
                hint = nearest(name, self.schema) or f"; the file has {', '.join(self.schema)}"
                self.refuse(
                    node,
                    f"unknown column '{name}'{hint} It stands"
                    if hint.endswith("?")
                    else f"unknown column '{name}'{hint}; it stands",
                )
        if name not in self.columns:
            self.columns.append(name)
        dtype = self.schema[name]
        if dtype == pl.Boolean:
            return pl.col(name), "truth"
        if dtype.is_numeric():
            return pl.col(name).cast(pl.Float64), "number"
        if dtype in (pl.String, pl.Categorical, pl.Enum) or dtype.is_temporal():
            return pl.col(name).cast(pl.String), "text"
        self.refuse(node, f"column '{name}' holds neither numbers nor text")

    def binary(self, node: ast.BinOp) -> pl.Expr:
        left, right = self.number(node.left), self.number(node.right)
        if not isinstance(node.op, (ast.Mult, ast.Div)):
            self.product = False
        if isinstance(node.op, ast.Add):
            return left + right
        if isinstance(node.op, ast.Sub):
            return left - right
        if isinstance(node.op, ast.Mult):
            return left * right
        if isinstance(node.op, ast.Div):
            return left / right
        if isinstance(node.op, ast.Pow):
            return left.pow(right)
        if isinstance(node.op, ast.BitXor):
            self.refuse(node, "a power is written **, not ^,")
        if isinstance(node.op, (ast.BitAnd, ast.BitOr)):
            self.refuse(node, "write 'and', 'or' instead of & and |")
        self.refuse(node, "this operator is not available")

    def compare(self, node: ast.Compare) -> pl.Expr:
        self.product = False
        operands = [node.left, *node.comparators]
        visited = [self.visit(operand) for operand in operands]
        joined: pl.Expr | None = None
        for i, operator in enumerate(node.ops):
            (left, left_kind), (right, right_kind) = visited[i], visited[i + 1]
            if (left_kind == "text") != (right_kind == "text"):
                self.refuse(
                    operands[i + 1], "text is compared with a number (only text stands in quotes)"
                )
            if left_kind != right_kind:
                left, right = left.cast(pl.Float64), right.cast(pl.Float64)
            if isinstance(operator, ast.Eq):
                part = left == right
            elif isinstance(operator, ast.NotEq):
                part = left != right
            elif isinstance(operator, ast.Lt):
                part = left < right
            elif isinstance(operator, ast.LtE):
                part = left <= right
            elif isinstance(operator, ast.Gt):
                part = left > right
            elif isinstance(operator, ast.GtE):
                part = left >= right
            else:
                self.refuse(node, "only == != < <= > >= compare; 'in' and 'is' are not available")
            joined = part if joined is None else joined & part
        assert joined is not None
        return joined

    def call(self, node: ast.Call) -> pl.Expr:
        self.product = False
        if not isinstance(node.func, ast.Name) or node.func.id not in _FUNCTIONS:
            name = node.func.id if isinstance(node.func, ast.Name) else "this"
            self.refuse(
                node, f"'{name}' is not a function here (there are {', '.join(_FUNCTIONS)}),"
            )
        if node.keywords or any(isinstance(argument, ast.Starred) for argument in node.args):
            self.refuse(node, "functions take plain arguments only,")
        name = node.func.id
        arguments = [self.number(argument) for argument in node.args]
        if name in ("min", "max"):
            if len(arguments) < 2:
                self.refuse(node, f"{name} takes two or more values,")
            return pl.min_horizontal(arguments) if name == "min" else pl.max_horizontal(arguments)
        if len(arguments) != 1:
            self.refuse(node, f"{name} takes one value,")
        result: pl.Expr = getattr(arguments[0], name)()
        return result
