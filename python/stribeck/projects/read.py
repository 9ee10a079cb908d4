"""Reading a project file: everything that is not understood is refused with its line."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stribeck.base.errors import ProjectError, nearest
from stribeck.models.reader import read_model
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.kept import Kept
from stribeck.projects.node import CHANGES, Node
from stribeck.projects.source import READING, Source
from stribeck.projects.tree import Tree
from stribeck.projects.write import SCHEMA

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

if TYPE_CHECKING:
    from stribeck.projects.project import Project

VERDICTS = ("missing", "none", "unexplained")
TOP_KEYS = ("kind", "schema", "current", "data", "reading", "nodes")
DATA_KEYS = ("path", "sha256", "sidecar_sha256")
NODE_KEYS = ("parent", "change", "name", "found", "rejected", "diagnosis", "model")
FOUND_KEYS = ("effect", "confidence", "rmse_held_out", "share", "where", "ties")
DIAGNOSIS_KEYS = ("verdict", "noise_floor", "left", "left_where", "findings")


def read_project(path: Path) -> Project:
    """Read a project file.

    Raises
    ------
    ProjectError, ModelFileError
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not text"
        raise ProjectError(f"cannot read the project {path}: {reason}") from None
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ProjectError(f"{path}: not a TOML file ({error})") from None
    return _Reader(path, text).project(data)


class _Reader:
    """Reads one file; keeps its text to tell the line of what is wrong."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.rows = text.splitlines()
        self.text = text

    def stop(self, what: str, *words: str) -> ProjectError:
        """An error that names the line on which the last of `words` stands, each after the last."""
        line = 0
        for word in words:
            line = next((k for k in range(line, len(self.rows)) if word in self.rows[k]), line)
        where = f", line {line + 1}" if words else ""
        return ProjectError(f"{self.path}{where}: {what}")

    def project(self, data: Mapping[str, Any]) -> Project:
        from stribeck.projects.project import Project

        if data.get("kind") != "project":
            raise self.stop(
                f'this is not a project: kind is {data.get("kind")!r}, "project" is needed',
                *(["kind"] if "kind" in data else []),
            )
        if data.get("schema") != SCHEMA:
            raise self.stop(
                f"schema {data.get('schema')!r} is not known here, {SCHEMA} is", "schema"
            )
        self._known(data, TOP_KEYS)
        for key in ("data", "nodes"):
            if not isinstance(data.get(key), dict) or not data[key]:
                raise self.stop(f"the table [{key}] is missing")
        tree = Tree(self._nodes(data["nodes"]))
        current = data.get("current")
        if current not in [node.number for node in tree]:
            raise self.stop(f"current is {current!r}, and there is no such node", "current")
        return Project(self.path, self._source(data), tree, current)

    def _source(self, data: Mapping[str, Any]) -> Source:
        said, reading = data["data"], data.get("reading", {})
        self._known(said, DATA_KEYS, "[data]")
        texts = {key: self._text(said, key, "[data]") for key in ("path", "sha256")}
        if not isinstance(reading, dict):
            raise self.stop(f"reading is {reading!r}, a table is needed", "reading")
        self._known(reading, READING, "[reading]")
        beside = self._text(said, "sidecar_sha256", "[data]") if "sidecar_sha256" in said else None
        return Source(self.path.parent, texts["path"], texts["sha256"], beside, reading)

    def _nodes(self, tables: Mapping[str, Any]) -> tuple[Node, ...]:
        nodes: list[Node] = []
        for word, table in tables.items():
            header = f"[nodes.{word}"
            if not word.isdecimal() or not isinstance(table, dict):
                raise self.stop(f"node {word!r} is not a numbered table", header)
            nodes.append(self._node(int(word), table, header, nodes))
        return tuple(nodes)

    def _node(self, number: int, table: Mapping[str, Any], header: str, before: list[Node]) -> Node:
        self._known(table, NODE_KEYS, header)
        change = table.get("change")
        if change not in CHANGES:
            raise self.stop(f"change is {change!r}; it is {' or '.join(CHANGES)}", header, "change")
        if not isinstance(table.get("model"), dict):
            raise self.stop(f"node {number} has no model", header)
        kept = Kept(read_model(table["model"], self.path, self.text, f"[nodes.{number}.model]"))
        fitted_on, place = kept.file.fitted_on, f"[nodes.{number}.model.fitted_on]"
        self._number(fitted_on, "rmse_held_out", place)
        if self._number(fitted_on, "rmse", place) is None:
            raise self.stop(f"the model of node {number} has no rmse", header)
        found = self._found(table["found"], f"[nodes.{number}.found]") if "found" in table else None
        node = Node(
            number,
            table.get("parent"),
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
        """A node must be what its parent and its change make of it."""
        if (node.change == "base") != (not before):
            raise self.stop("the first node is the base, and no other", header, "change")
        if node.number in [other.number for other in before]:
            raise self.stop(f"node {node.number} is there twice", header)
        if not before:
            if node.parent is not None or node.found is not None:
                raise self.stop("the base has neither a parent nor an effect", header)
            return
        parent = next((other for other in before if other.number == node.parent), None)
        if parent is None:
            raise self.stop(f"parent is {node.parent!r}, and no such node is above", header)
        if node.effect is None:
            raise self.stop(f"node {node.number} does not say which effect was found", header)
        effects = set(parent.kept.model.spec.split("+"))
        effects = effects | {node.effect} if node.change == "add" else effects - {node.effect}
        if effects != set(node.kept.model.spec.split("+")):
            raise self.stop(
                f"the model {node.kept.model.spec} is not that of node {node.parent}, "
                f"{parent.kept.model.spec}, {node.label}",
                header,
            )

    def _rejected(self, table: Mapping[str, Any], number: int) -> dict[str, str]:
        rows = table.get("rejected", {})
        header = f"[nodes.{number}.rejected]"
        if not isinstance(rows, dict):
            raise self.stop(f"rejected is {rows!r}, a table is needed", header)
        return {effect: self._text(rows, effect, header) for effect in rows}

    def _diagnosis(self, table: Mapping[str, Any], number: int) -> Remembered | None:
        said = table.get("diagnosis")
        if said is None:
            return None
        header = f"[nodes.{number}.diagnosis"
        if not isinstance(said, dict) or said.get("verdict") not in VERDICTS:
            raise self.stop(f"the verdict is {' or '.join(VERDICTS)}", header)
        self._known(said, DIAGNOSIS_KEYS, header)
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

    def _found(self, row: Any, header: str) -> Found:
        if not isinstance(row, dict):
            raise self.stop(f"a finding is {row!r}, a table is needed", header)
        self._known(row, FOUND_KEYS, header)
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

    def _known(self, table: Mapping[str, Any], keys: tuple[str, ...], *words: str) -> None:
        for key in table:
            if key not in keys:
                raise self.stop(f"key {key!r} is unknown{nearest(key, keys)}", *words, key)

    def _text(self, table: Mapping[str, Any], key: str, header: str) -> str:
        value = table.get(key)
        if not isinstance(value, str):
            raise self.stop(f"{key} is {value!r}, a text is needed", header, key)
        return value

    def _number(self, table: Mapping[str, Any], key: str, header: str) -> float | None:
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
