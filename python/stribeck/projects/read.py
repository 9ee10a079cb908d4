"""Reading a project file: invalid contents are refused, with the line."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from stribeck.base.errors import ProjectError
from stribeck.base.toml import TomlText, read_text
from stribeck.models.reader import read_model
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.kept import Kept
from stribeck.projects.node import CHANGES, Node
from stribeck.projects.source import READING, Source, Stored
from stribeck.projects.tree import Tree
from stribeck.projects.write import SCHEMA

VERDICTS = ("missing", "none", "unexplained")
TOP_KEYS = ("kind", "schema", "current", "data", "reading", "nodes")
DATA_KEYS = ("path", "sha256", "sidecar_sha256")
NODE_KEYS = ("parent", "change", "name", "found", "rejected", "diagnosis", "model")
FOUND_KEYS = ("effect", "confidence", "rmse_held_out", "share", "where", "ties")
DIAGNOSIS_KEYS = ("verdict", "noise_floor", "left", "left_where", "findings")


class StoredProject(NamedTuple):
    """What a project file contains."""

    source: Source
    tree: Tree
    current: int


def read_project(path: Path) -> StoredProject:
    """Read a project file.

    Raises
    ------
    ProjectError, ModelFileError
        The file cannot be read, or is not a project; the message names the line.
    """
    text = TomlText(path, read_text(path, "project", ProjectError), ProjectError)
    return _Reader(text).project(text.parsed())


class _Reader:
    """Reads one project file; errors name the line."""

    def __init__(self, text: TomlText) -> None:
        self.text = text
        self.path = text.path
        self.stop = text.stop

    def project(self, data: Mapping[str, object]) -> StoredProject:
        if data.get("kind") != "project":
            raise self.stop(
                f'this is not a project: kind is {data.get("kind")!r}, "project" is needed',
                *(["kind"] if "kind" in data else []),
            )
        if data.get("schema") != SCHEMA:
            raise self.stop(
                f"schema {data.get('schema')!r} is unknown, {SCHEMA} is needed", "schema"
            )
        self.text.check_keys(data, TOP_KEYS)
        files = self._files(data)
        tree = Tree(self._nodes(self._table(data, "nodes")))
        current = data.get("current")
        if not isinstance(current, int) or current not in [node.number for node in tree]:
            raise self.stop(f"current is {current!r}, but there is no such node", "current")
        reading = data.get("reading", {})
        if not isinstance(reading, dict):
            raise self.stop(f"reading is {reading!r}, a table is needed", "reading")
        self.text.check_keys(reading, READING, "[reading]")
        return StoredProject(Source(self.path.parent, files, reading), tree, current)

    def _table(self, data: Mapping[str, object], key: str) -> Mapping[str, object]:
        table = data.get(key)
        if not isinstance(table, dict) or not table:
            raise self.stop(f"the table [{key}] is missing")
        return table

    def _files(self, data: Mapping[str, object]) -> tuple[Stored, ...]:
        """The data files: a table, or one for each of several."""
        stored = data.get("data")
        if not isinstance(stored, list):
            return (self._file(self._table(data, "data"), "[data]"),)
        if not stored or not all(isinstance(table, dict) for table in stored):
            raise self.stop("a table [[data]] for each file is needed", "data")
        return tuple(self._file(table, "[[data]]") for table in stored)

    def _file(self, stored: Mapping[str, object], header: str) -> Stored:
        self.text.check_keys(stored, DATA_KEYS, header)
        path, sha256 = (self._text(stored, key, header) for key in ("path", "sha256"))
        key = "sidecar_sha256"
        return Stored(path, sha256, self._text(stored, key, header) if key in stored else None)

    def _nodes(self, tables: Mapping[str, object]) -> tuple[Node, ...]:
        nodes: list[Node] = []
        for word, table in tables.items():
            header = f"[nodes.{word}"
            if not word.isdecimal() or not isinstance(table, dict):
                raise self.stop(f"node {word!r} is not a numbered table", header)
            nodes.append(self._node(int(word), table, header, nodes))
        return tuple(nodes)

    def _node(
        self, number: int, table: Mapping[str, object], header: str, before: list[Node]
    ) -> Node:
        self.text.check_keys(table, NODE_KEYS, header)
        change, parent = table.get("change"), table.get("parent")
        if not isinstance(change, str) or change not in CHANGES:
            raise self.stop(f"change is {change!r}; it is {' or '.join(CHANGES)}", header, "change")
        if not isinstance(parent, int | None):
            raise self.stop(f"parent is {parent!r}, but no earlier node has this number", header)
        model = table.get("model")
        if not isinstance(model, dict):
            raise self.stop(f"node {number} has no model", header)
        kept = Kept(read_model(model, self.path, self.text.text, f"[nodes.{number}.model]"))
        fitted_on, place = kept.file.fitted_on, f"[nodes.{number}.model.fitted_on]"
        self._number(fitted_on, "rmse_held_out", place)
        if self._number(fitted_on, "rmse", place) is None:
            raise self.stop(f"the model of node {number} has no rmse", header)
        found = self._found(table["found"], f"[nodes.{number}.found]") if "found" in table else None
        node = Node(
            number,
            parent,
            change,
            found,
            kept,
            name=self._text(table, "name", header) if "name" in table else "",
            rejected=self._rejected(table, number),
            diagnosis=self._diagnosis(table, number),
        )
        self._check_place(node, before, header)
        return node

    def _check_place(self, node: Node, before: list[Node], header: str) -> None:
        """Raise if the model of a node does not follow from its parent and its change."""
        if (node.change == "base") != (not before):
            raise self.stop("the first node, and no other, must be the base", header, "change")
        if node.number in [other.number for other in before]:
            raise self.stop(f"node {node.number} is given twice", header)
        if not before:
            if node.parent is not None or node.found is not None:
                raise self.stop("the base has neither a parent nor an effect", header)
            return
        parent = next((other for other in before if other.number == node.parent), None)
        if parent is None:
            raise self.stop(
                f"parent is {node.parent!r}, but no earlier node has this number", header
            )
        if node.effect is None:
            raise self.stop(f"node {node.number} names no effect", header)
        effects = set(parent.kept.model.spec.split("+"))
        effects = effects | {node.effect} if node.change == "add" else effects - {node.effect}
        if effects != set(node.kept.model.spec.split("+")):
            raise self.stop(
                f"the model {node.kept.model.spec} does not follow from node {node.parent}, "
                f"{parent.kept.model.spec}, and the change {node.label}",
                header,
            )

    def _rejected(self, table: Mapping[str, object], number: int) -> dict[str, str]:
        rows = table.get("rejected", {})
        header = f"[nodes.{number}.rejected]"
        if not isinstance(rows, dict):
            raise self.stop(f"rejected is {rows!r}, a table is needed", header)
        return {effect: self._text(rows, effect, header) for effect in rows}

    def _diagnosis(self, table: Mapping[str, object], number: int) -> Remembered | None:
        said = table.get("diagnosis")
        if said is None:
            return None
        header = f"[nodes.{number}.diagnosis"
        if not isinstance(said, dict) or said.get("verdict") not in VERDICTS:
            raise self.stop(f"the verdict is {' or '.join(VERDICTS)}", header)
        self.text.check_keys(said, DIAGNOSIS_KEYS, header)
        rows = said.get("findings", [])
        if not isinstance(rows, list):
            raise self.stop(f"findings is {rows!r}, a list of tables is needed", header)
        return Remembered(
            said["verdict"],
            self._number(said, "noise_floor", header),
            self._number(said, "left", header),
            self._text(said, "left_where", header) if "left_where" in said else None,
            tuple(self._found(row, header) for row in rows),
        )

    def _found(self, row: object, header: str) -> Found:
        if not isinstance(row, dict):
            raise self.stop(f"a finding is {row!r}, a table is needed", header)
        self.text.check_keys(row, FOUND_KEYS, header)
        ties = row.get("ties", [])
        if not isinstance(ties, list) or not all(isinstance(tie, str) for tie in ties):
            raise self.stop(f"ties is {ties!r}, a list of names is needed", header, "ties")
        return Found(
            self._text(row, "effect", header),
            self._number(row, "confidence", header),
            self._number(row, "rmse_held_out", header),
            self._number(row, "share", header),
            self._text(row, "where", header) if "where" in row else "",
            tuple(ties),
        )

    def _text(self, table: Mapping[str, object], key: str, header: str) -> str:
        value = table.get(key)
        if not isinstance(value, str):
            raise self.stop(f"{key} is {value!r}, a text is needed", header, key)
        return value

    def _number(self, table: Mapping[str, object], key: str, header: str) -> float | None:
        value = table.get(key)
        if value is None:
            return None
        if (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or not math.isfinite(value)
        ):
            raise self.stop(f"{key} is {value!r}, a finite number is needed", header, key)
        return float(value)
