"""A step of a model as a list of operations, placed in branches.

The core lists the operations of one step, with both alternatives of every choice. Here an operation
that only one alternative needs is moved into its branch, so that the exported program computes no
more than the core does.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

from stribeck.exporters.rows import Argument
from stribeck.models.model import Model

#: Operations whose result is true or false.
MASKS = frozenset({"below", "above", "equal", "and", "or", "not", "is_finite"})

#: Operations that are written where they are used.
LEAVES = frozenset({"constant", "parameter", "channel", "time_step", "state"})


@dataclass(frozen=True)
class Operation:
    """One operation; its number in the list is its node.

    Attributes
    ----------
    name
        ``add``, ``exp``, ``choose`` ...; ``constant``, ``parameter``, ``channel``, ``time_step``
        and ``state`` take no operands.
    operands
        Nodes of the operands, all earlier in the list.
    argument
        Value of a constant, index of a parameter or state, name of a channel, order of ``phi``.
    """

    name: str
    operands: tuple[int, ...]
    argument: Argument

    @property
    def value(self) -> float:
        """Value of a constant."""
        assert isinstance(self.argument, float)
        return self.argument

    @property
    def index(self) -> int:
        """Index of a parameter or a state."""
        assert isinstance(self.argument, int)
        return self.argument

    @property
    def channel(self) -> str:
        """Name of a channel."""
        assert isinstance(self.argument, str)
        return self.argument


@dataclass(frozen=True)
class StateNumber:
    """A state of a model: 0 at the start, the value of node `after` at the end of a step."""

    name: str
    unit: str
    what: str
    after: int


@dataclass(frozen=True)
class Choice:
    """Consecutive choices by one mask: each node takes its value from branch `yes` or `no`."""

    mask: int
    nodes: tuple[int, ...]
    yes: Branch
    no: Branch

    @property
    def branches(self) -> tuple[Branch, Branch]:
        """The branches where the mask is true and where it is false."""
        return self.yes, self.no


@dataclass
class Branch:
    """The nodes and choices of one branch, in order."""

    parent: Branch | None = None
    items: list[int | Choice] = field(default_factory=list)

    @cached_property
    def depth(self) -> int:
        """Number of enclosing branches."""
        return 0 if self.parent is None else self.parent.depth + 1


@dataclass(frozen=True)
class Program:
    """One step of a model.

    Attributes
    ----------
    operations
        In an order of evaluation.
    torque
        Node of the torque at the end of the step.
    states
        States, kept from step to step.
    """

    operations: tuple[Operation, ...]
    torque: int
    states: tuple[StateNumber, ...]

    @classmethod
    def of(cls, model: Model, precision: Literal["double", "single"] = "double") -> Program:
        """The step of a model; constants are computed in the given precision.

        Examples
        --------
        >>> from stribeck.models.build import model
        >>> [number.name for number in Program.of(model("lugre")).states]
        ['deflection']
        """
        listed = model.core.program(single=precision == "single")
        return cls(
            operations=tuple(Operation(n, tuple(o), x) for n, o, x in listed["operations"]),
            torque=listed["torque"],
            states=tuple(
                StateNumber(row["name"], row["unit"], row["what"], row["after"])
                for row in listed["states"]
            ),
        )

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """The channels that it reads, in order of their first use."""
        return tuple(dict.fromkeys(o.channel for o in self.operations if o.name == "channel"))

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
        """Whether the result of a node is true or false."""
        return self.operations[node].name in MASKS

    def branches(self) -> Branch:
        """The whole step, each operation in the innermost branch that holds all its uses."""
        return _Placing(self).root


class _Placing:
    """Finds the branch of each node, from the last node to the first."""

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
    """Choices by one mask with only leaves between them, none an operand of another."""
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
