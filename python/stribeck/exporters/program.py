"""A model's step as operations, and in which branch each of them is needed.

The core writes down what one step of a model computes, both ways of every choice included. Here
each operation is moved into the branch in which alone it is needed, so that a program computes no
more than the core does.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

from stribeck.models.model import Model

#: Operations that answer yes or no.
MASKS = frozenset({"below", "above", "equal", "and", "or", "not", "is_finite"})

#: Operations that are written where they are used.
LEAVES = frozenset({"constant", "parameter", "channel", "time_step", "state"})


@dataclass(frozen=True)
class Operation:
    """What one node computes.

    Attributes
    ----------
    name
        ``add``, ``exp``, ``choose`` ...; ``constant``, ``parameter``, ``channel``, ``time_step``
        and ``state`` take no operands.
    operands
        The nodes it takes its numbers from; all come before it.
    said
        Value of a constant, index of a parameter or state, name of a channel, order of ``phi``.
    """

    name: str
    operands: tuple[int, ...]
    said: Any


@dataclass(frozen=True)
class StateNumber:
    """A number that a model remembers: 0 at the start, node `after` at the end of a step."""

    name: str
    unit: str
    what: str
    after: int


@dataclass(frozen=True)
class Choice:
    """Consecutive choices by one mask: the node's number is that of `yes` where it holds."""

    mask: int
    nodes: tuple[int, ...]
    yes: Branch
    no: Branch

    @property
    def branches(self) -> tuple[Branch, Branch]:
        """What is computed where the mask holds, and where it does not."""
        return self.yes, self.no


@dataclass
class Branch:
    """What is computed in one branch, in order: nodes and further choices."""

    parent: Branch | None = None
    items: list[int | Choice] = field(default_factory=list)

    @cached_property
    def depth(self) -> int:
        """How many branches it is in."""
        return 0 if self.parent is None else self.parent.depth + 1


@dataclass(frozen=True)
class Program:
    """One step of a model.

    Attributes
    ----------
    operations
        In an order in which they can be computed.
    torque
        The node that yields the torque at the end of the step.
    states
        What is remembered from step to step.
    """

    operations: tuple[Operation, ...]
    torque: int
    states: tuple[StateNumber, ...]

    @classmethod
    def of(cls, model: Model, precision: Literal["double", "single"] = "double") -> Program:
        """The step of a model; what is known beforehand is computed in this precision.

        Examples
        --------
        >>> from stribeck.models.build import model
        >>> [number.name for number in Program.of(model("lugre")).states]
        ['deflection']
        """
        told = model.core.program(single=precision == "single")
        return cls(
            operations=tuple(Operation(n, tuple(o), said) for n, o, said in told["operations"]),
            torque=told["torque"],
            states=tuple(
                StateNumber(row["name"], row["unit"], row["what"], row["after"])
                for row in told["states"]
            ),
        )

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """The channels it reads, in the order in which it does."""
        return tuple(dict.fromkeys(o.said for o in self.operations if o.name == "channel"))

    @property
    def functions(self) -> frozenset[str]:
        """Names of all operations."""
        return frozenset(operation.name for operation in self.operations)

    @property
    def outputs(self) -> tuple[int, ...]:
        """The torque and the states after the step."""
        return (self.torque, *(number.after for number in self.states))

    def is_leaf(self, node: int) -> bool:
        """Whether a node is written where it is used."""
        return self.operations[node].name in LEAVES

    def is_mask(self, node: int) -> bool:
        """Whether a node answers yes or no."""
        return self.operations[node].name in MASKS

    def branches(self) -> Branch:
        """The whole step, each operation in the innermost branch in which it is needed."""
        return _Placing(self).root


class _Placing:
    """Finds the branch of each node, from the last to the first."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self.root = Branch()
        self.needed: dict[int, Branch] = {node: self.root for node in program.outputs}
        runs = {nodes[-1]: nodes for nodes in _runs(program)}
        placed: list[tuple[Branch, int | Choice]] = []
        for node in reversed(range(len(program.operations))):
            nodes = runs.get(node)
            if nodes is not None:
                placed.append(self._place_choice(nodes))
            elif program.operations[node].name != "choose" and not program.is_leaf(node):
                home = self.needed[node]
                for operand in program.operations[node].operands:
                    self._need(operand, home)
                placed.append((home, node))
        for home, item in reversed(placed):
            home.items.append(item)

    def _place_choice(self, nodes: tuple[int, ...]) -> tuple[Branch, Choice]:
        operations = self.program.operations
        home = self.needed[nodes[0]]
        for node in nodes:
            home = _innermost_common(home, self.needed[node])
        yes, no = Branch(home), Branch(home)
        mask = operations[nodes[0]].operands[0]
        self._need(mask, home)
        for node in nodes:
            _, chosen, other = operations[node].operands
            self._need(chosen, yes)
            self._need(other, no)
        return home, Choice(mask, nodes, yes, no)

    def _need(self, node: int, branch: Branch) -> None:
        known = self.needed.get(node)
        self.needed[node] = branch if known is None else _innermost_common(known, branch)


def _innermost_common(one: Branch, other: Branch) -> Branch:
    while one is not other:
        deeper = one if one.depth >= other.depth else other
        outside = deeper.parent
        assert outside is not None
        one, other = (outside, other) if deeper is one else (one, outside)
    return one


def _runs(program: Program) -> Iterator[tuple[int, ...]]:
    """Choices by one mask with only leaves between them, none of which takes another."""
    run: list[int] = []
    for node, operation in enumerate(program.operations):
        if program.is_leaf(node):
            continue
        joins = (
            operation.name == "choose"
            and run
            and operation.operands[0] == program.operations[run[0]].operands[0]
            and not set(run) & set(operation.operands)
        )
        if not joins and run:
            yield tuple(run)
            run = []
        if operation.name == "choose":
            run.append(node)
    if run:
        yield tuple(run)
