"""The operations of a program as statements in C."""

from __future__ import annotations

import math
from collections.abc import Iterator

from stribeck.exporters.c.number import Format
from stribeck.exporters.program import Branch, Choice, Program

_OPERATORS = {
    "add": "+",
    "subtract": "-",
    "multiply": "*",
    "divide": "/",
    "below": "<",
    "above": ">",
    "equal": "==",
    "and": "&&",
    "or": "||",
}

_INDENT = "    "


class Statements:
    """The body of a step: one operation a line, with a branch for each choice.

    Parameters
    ----------
    parameters
        Names of the parameters in C.
    functions
        Names of the elementary functions in C, by operation.
    """

    def __init__(
        self, program: Program, form: Format, parameters: tuple[str, ...], functions: dict[str, str]
    ) -> None:
        self.program = program
        self.form = form
        self.parameters = parameters
        self.functions = functions

    def __str__(self) -> str:
        lines = [
            f"{_INDENT}const {self.form.real} before_{number.name} = state->{number.name};"
            for number in self.program.states
        ]
        lines += self._branch(self.program.branches(), _INDENT)
        lines += [
            f"{_INDENT}state->{number.name} = {self._number(number.after)};"
            for number in self.program.states
        ]
        lines.append(f"{_INDENT}return {self._number(self.program.torque)};")
        return "\n".join(lines)

    def _branch(self, branch: Branch, indent: str) -> Iterator[str]:
        for item in branch.items:
            if isinstance(item, Choice):
                yield from self._choice(item, indent)
            else:
                kind = "bool" if self.program.is_mask(item) else self.form.real
                yield f"{indent}const {kind} t{item} = {self._value(item)};"

    def _choice(self, choice: Choice, indent: str) -> Iterator[str]:
        real, operations = self.form.real, self.program.operations
        mask = self._number(choice.mask)
        if not any(branch.items for branch in choice.branches):
            for node in choice.nodes:
                yes, no = (self._number(own) for own in operations[node].operands[1:])
                yield f"{indent}const {real} t{node} = {mask} ? {yes} : {no};"
            return
        for node in choice.nodes:
            yield f"{indent}{real} t{node};"
        for k, (branch, head) in enumerate(
            zip(choice.branches, (f"if ({mask}) {{", "} else {"), strict=True)
        ):
            yield indent + head
            yield from self._branch(branch, indent + _INDENT)
            for node in choice.nodes:
                chosen = self._number(operations[node].operands[1 + k])
                yield f"{indent}{_INDENT}t{node} = {chosen};"
        yield indent + "}"

    def _value(self, node: int) -> str:
        operation = self.program.operations[node]
        operands = [self._number(own) for own in operation.operands]
        if operation.name in _OPERATORS:
            return f"{operands[0]} {_OPERATORS[operation.name]} {operands[1]}"
        if operation.name == "negate":
            return f"-{operands[0]}"
        if operation.name == "not":
            return f"!{operands[0]}"
        return f"{self.functions[operation.name]}({', '.join(operands)})"

    def _number(self, node: int) -> str:
        operation = self.program.operations[node]
        match operation.name:
            case "constant" if math.isinf(operation.value):
                return "infinity()" if operation.value > 0.0 else "(-infinity())"
            case "constant":
                return self.form.literal(operation.value)
            case "parameter":
                return f"parameters->{self.parameters[operation.index]}"
            case "channel":
                return f"sample->{operation.channel}"
            case "time_step":
                return "dt"
            case "state":
                return f"before_{self.program.states[operation.index].name}"
        return f"t{node}"
