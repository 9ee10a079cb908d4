"""Writing a project file: TOML that people can read, edit and compare line by line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import tomlkit
from tomlkit.items import Table

from stribeck.base.errors import ProjectError
from stribeck.base.files import write_whole
from stribeck.projects.findings import Found, Remembered
from stribeck.projects.node import Node

if TYPE_CHECKING:
    from stribeck.projects.project import Project

#: Version of the file's layout.
SCHEMA = 1


def write_project(project: Project, path: Path) -> None:
    """Write a project atomically.

    Raises
    ------
    ProjectError
    """
    if path.resolve().parent != project.source.folder.resolve():
        raise ProjectError(
            f"cannot write {path}: a project stores the path of its data relative to "
            f"{project.source.folder.resolve()}, so write it to this folder"
        )
    write_whole(path, project_toml(project), ProjectError)


def project_toml(project: Project) -> str:
    """Return the text of the file, from which numbers are read back exactly."""
    source = project.source
    document = tomlkit.document()
    document.add("kind", tomlkit.item("project"))
    document.add("schema", tomlkit.item(SCHEMA))
    document.add("current", tomlkit.item(project.current))
    tables = [_table(one.to_dict()) for one in source.files]
    several = tomlkit.aot()
    for table in tables:
        several.append(table)
    document.add("data", several if len(tables) > 1 else tables[0])
    if source.reading:
        document.add("reading", _table(source.reading))
    nodes = tomlkit.table(is_super_table=True)
    for node in project.tree:
        nodes.add(str(node.number), _node_table(node))
    document.add("nodes", nodes)
    return tomlkit.dumps(document)


def _table(values: Mapping[str, object]) -> Table:
    """Return a TOML table without the empty values."""
    table = tomlkit.table()
    for key, value in values.items():
        if value is not None and value != "" and value != []:
            table.add(key, tomlkit.item(value))
    return table


def _node_table(node: Node) -> Table:
    table = _table({"parent": node.parent, "change": node.change, "name": node.name})
    if node.found is not None:
        table.add("found", _found_table(node.found))
    if node.rejected:
        rejected = tomlkit.table()
        for effect, why in node.rejected.items():
            rejected.add(effect, tomlkit.item(why))
        table.add("rejected", rejected)
    if node.diagnosis is not None:
        table.add("diagnosis", _diagnosis_table(node.diagnosis))
    model = tomlkit.table()
    node.kept.file.write_into(model)
    table.add("model", model)
    return table


def _found_table(found: Found) -> Table:
    return _table(
        {
            "effect": found.effect,
            "confidence": found.confidence,
            "rmse_held_out": found.rmse_held_out,
            "share": found.share,
            "where": found.where,
            "ties": list(found.ties),
        }
    )


def _diagnosis_table(said: Remembered) -> Table:
    table = _table(
        {
            "verdict": said.verdict,
            "noise_floor": said.noise_floor,
            "left": said.left,
            "left_where": said.left_where,
        }
    )
    if said.findings:
        rows = tomlkit.aot()
        for found in said.findings:
            rows.append(_found_table(found))
        table.add("findings", rows)
    return table
