"""The nodes of a project as a tree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from stribeck.base.errors import ProjectError, nearest
from stribeck.fitting.result import Fit
from stribeck.projects.node import Node


@dataclass(frozen=True)
class Tree:
    """Nodes by number, parents before their children; the first is the base."""

    nodes: tuple[Node, ...]

    def __iter__(self) -> Iterator[Node]:
        return iter(self.nodes)

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    def root(self) -> Node:
        """The base model."""
        return self.nodes[0]

    def node(self, number: int) -> Node:
        """The node with this number."""
        return next(node for node in self.nodes if node.number == number)

    def find(self, said: str | int) -> Node:
        """Return the node with a number or name.

        Raises
        ------
        ProjectError
        """
        word = str(said).strip()
        for node in self.nodes:
            if word and word in (str(node.number), node.name):
                return node
        names = [node.name for node in self.nodes if node.name]
        known = ", ".join([*(str(node.number) for node in self.nodes), *names])
        raise ProjectError(f"there is no node {word!r}{nearest(word, names)}; there are {known}")

    def children(self, number: int) -> tuple[Node, ...]:
        """The nodes whose parent is this node."""
        return tuple(node for node in self.nodes if node.parent == number)

    def child(self, number: int, change: str, effect: str) -> Node | None:
        """The child with this change of a node, if there is one."""
        return next(
            (n for n in self.children(number) if (n.change, n.effect) == (change, effect)), None
        )

    def path(self, number: int) -> tuple[Node, ...]:
        """The nodes from the base to a node."""
        node = self.node(number)
        before = () if node.parent is None else self.path(node.parent)
        return (*before, node)

    def rejected(self, number: int) -> dict[str, str]:
        """Effects rejected at a node or its ancestors, with the reasons."""
        return {e: why for node in self.path(number) for e, why in node.rejected.items()}

    def accepting(self, number: int, effect: str) -> Tree:
        """Return the tree without rejections of an effect at a node and its ancestors."""
        tree = self
        for node in self.path(number):
            if effect in node.rejected:
                left = {e: why for e, why in node.rejected.items() if e != effect}
                tree = tree.with_changed(node.number, rejected=left)
        return tree

    def holding(self, fitted: Fit) -> Node | None:
        """The node that stores this fit object, if there is one."""
        return next((node for node in self.nodes if node.kept.holds(fitted)), None)

    def with_node(self, **said: Any) -> tuple[Tree, Node]:
        """Return the tree with a new node, and the node."""
        node = Node(number=max(n.number for n in self.nodes) + 1, **said)
        return Tree((*self.nodes, node)), node

    def with_changed(self, number: int, **said: Any) -> Tree:
        """Return the tree with one node changed."""
        return Tree(tuple(replace(n, **said) if n.number == number else n for n in self.nodes))

    @property
    def noise_floor(self) -> float | None:
        """The noise floor estimated with the best of the diagnosed models."""
        known = [n for n in self.nodes if n.diagnosis and n.diagnosis.noise_floor is not None]
        if not known:
            return None
        best = min(known, key=lambda node: node.kept.rmse_held_out or node.kept.rmse)
        assert best.diagnosis is not None
        return best.diagnosis.noise_floor
