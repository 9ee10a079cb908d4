"""A program as the compiled core lists it, as types."""

from __future__ import annotations

from typing import TypeAlias, TypedDict

__all__ = ["Argument", "ProgramRow", "StateRow"]

#: Value of a constant, index of a parameter or state, name of a channel, order of ``phi``.
Argument: TypeAlias = float | int | str | None


class StateRow(TypedDict):
    """One state: its name, its unit (T and X as in the catalog), what it is, its last node."""

    name: str
    unit: str
    what: str
    after: int


class ProgramRow(TypedDict):
    """Operations as name, operands and argument; the node of the torque; the states."""

    operations: list[tuple[str, list[int], Argument]]
    torque: int
    states: list[StateRow]
