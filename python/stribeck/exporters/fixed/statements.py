"""The operations of a program as statements in C on whole numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from stribeck.exporters.fixed.analysis import Analysis, Number


class Statements:
    """The body of a step, one operation a line, and the tables that it reads.

    Shifts are written as multiplications and divisions by powers of two, since the shift of a
    negative number differs between C compilers.
    """

    def __init__(self, analysis: Analysis) -> None:
        self.analysis = analysis
        self.program = analysis.program
        self.word = f"int{analysis.bits}_t"
        self.wide = f"int{2 * analysis.bits}_t"
        self.tables: list[str] = []
        self.lines = list(self._statements())

    def _statements(self) -> Iterator[str]:
        for node in sorted(self._needed()):
            number = self.analysis.numbers[node]
            if self.program.is_mask(node):
                yield f"const bool t{node} = {self._mask(node)};"
            else:
                yield f"const {self.word} t{node} = {self._value(node, number)};"
        yield f"return {self._number(self.program.torque)};"

    def _needed(self) -> set[int]:
        """The nodes that the torque depends on and that are not constant over the box."""
        needed: set[int] = set()
        open_ = [self.program.torque]
        while open_:
            node = open_.pop()
            if node in needed or self.program.is_leaf(node) or self._known(node).is_fixed:
                continue
            needed.add(node)
            operands = self._operands(node)
            if self.program.operations[node].name == "choose" and self._known(operands[0]).is_fixed:
                operands = operands[1:2] if self._known(operands[0]).low else operands[2:]
            open_.extend(operands)
        return needed

    def _operands(self, node: int) -> tuple[int, ...]:
        return self.program.operations[node].operands

    def _known(self, node: int) -> Number:
        return self.analysis.numbers[node]

    def _literal(self, x: int) -> str:
        return (
            f"INT{2 * self.analysis.bits}_C({x})"
            if x >= 0
            else f"(-INT{2 * self.analysis.bits}_C({-x}))"
        )

    def _number(self, node: int) -> str:
        """A node in its own format."""
        operation, number = self.program.operations[node], self._known(node)
        if self.program.is_mask(node):
            return str(bool(number.low)).lower() if number.is_fixed else f"t{node}"
        if number.is_fixed:
            return f"(({self.word}){self._literal(round(math.ldexp(number.low, number.digits)))})"
        return f"sample->{operation.channel}" if operation.name == "channel" else f"t{node}"

    def _moved(self, text: str, by: int) -> str:
        """A wide number with `by` more digits behind the point, or fewer.

        A power of two beyond the wide numbers is divided by in steps: it leaves nothing.
        """
        most = 2 * self.analysis.bits - 2
        if by < -most:
            return self._moved(f"({text} / {self._literal(2**most)})", by + most)
        if by == 0:
            return text
        return f"({text} {'*' if by > 0 else '/'} {self._literal(2 ** abs(by))})"

    def _in(self, node: int, digits: int) -> str:
        """A node as a wide number with so many digits behind the point."""
        return self._moved(f"({self.wide}){self._number(node)}", digits - self._known(node).digits)

    def _mask(self, node: int) -> str:
        name, operands = self.program.operations[node].name, self._operands(node)
        if name in ("and", "or"):
            sign = "&&" if name == "and" else "||"
            return f"{self._number(operands[0])} {sign} {self._number(operands[1])}"
        if name == "not":
            return f"!{self._number(operands[0])}"
        x, y = (self._known(own) for own in operands)
        digits = self.analysis.aligned(x, y)
        sign = {"below": "<", "above": ">", "equal": "=="}[name]
        return f"{self._in(operands[0], digits)} {sign} {self._in(operands[1], digits)}"

    def _value(self, node: int, number: Number) -> str:
        name, operands = self.program.operations[node].name, self._operands(node)
        match name:
            case "choose":
                return self._choice(operands, number)
            case "add" | "subtract":
                x, y = (self._known(own) for own in operands)
                digits = self.analysis.aligned(x, y)
                sign = "+" if name == "add" else "-"
                sum_ = f"({self._in(operands[0], digits)} {sign} {self._in(operands[1], digits)})"
                return f"narrow({self._moved(sum_, number.digits - digits)})"
            case "multiply":
                return self._product(operands[0], operands[1], number)
            case "divide":
                return self._quotient(operands[0], operands[1], number)
            case "power" if number.table is None:
                squared = self._known(operands[1]).low == 2.0
                return (
                    self._product(operands[0], operands[0], number)
                    if squared
                    else self._number(operands[0])
                )
            case "negate":
                return f"narrow(-({self.wide}){self._number(operands[0])})"
            case "abs":
                own = f"({self.wide}){self._number(operands[0])}"
                return f"narrow(({own} < 0) ? -{own} : {own})"
            case "sign":
                own, one = self._number(operands[0]), 2**number.digits
                return f"({self.word})(({own} > 0) ? {one} : (({own} < 0) ? -{one} : 0))"
        return self._read(node, operands[0], number)

    def _choice(self, operands: tuple[int, ...], number: Number) -> str:
        mask = self._known(operands[0])
        if mask.is_fixed:
            return self._number(operands[1] if mask.low else operands[2])
        yes, no = (self._in(own, number.digits) for own in operands[1:])
        return f"narrow({self._number(operands[0])} ? {yes} : {no})"

    def _product(self, x: int, y: int, number: Number) -> str:
        product = f"(({self.wide}){self._number(x)} * ({self.wide}){self._number(y)})"
        by = number.digits - self._known(x).digits - self._known(y).digits
        return f"narrow({self._moved(product, by)})"

    def _quotient(self, x: int, y: int, number: Number) -> str:
        by = number.digits + self._known(y).digits - self._known(x).digits
        above, below = f"({self.wide}){self._number(x)}", f"({self.wide}){self._number(y)}"
        if by >= 0:
            return f"narrow({self._moved(above, by)} / {below})"
        return f"narrow({self._moved(f'({above} / {below})', by)})"

    def _read(self, node: int, operand: int, number: Number) -> str:
        table = number.table
        assert table is not None
        entries = np.round(np.ldexp(table.values, number.digits)).astype(np.int64)
        rows = [", ".join(str(x) for x in entries[k : k + 10]) for k in range(0, entries.size, 10)]
        self.tables.append(
            f"static const {self.word} table_{node}[{entries.size}] = {{\n    "
            + ",\n    ".join(rows)
            + "\n};"
        )
        given = f"({self.wide}){self._number(operand)} - {self._literal(table.start)}"
        return f"between(table_{node}, {entries.size}, {self._literal(table.cell)}, {given})"
