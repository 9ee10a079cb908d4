"""A project as JSON and as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import polars as pl

if TYPE_CHECKING:
    from stribeck.projects.node import Node
    from stribeck.projects.project import Project
    from stribeck.projects.tree import Tree

#: Columns of the table, with the corresponding keys in the JSON of a node.
COLUMNS = {
    "node": ("node", pl.Int64),
    "parent": ("parent", pl.Int64),
    "change": ("change", pl.String),
    "effect": ("effect", pl.String),
    "name": ("name", pl.String),
    "model": ("model", pl.String),
    "rmse": ("rmse_after", pl.Float64),
    "rmse_held_out": ("rmse_held_out_after", pl.Float64),
    "confidence": ("confidence", pl.Float64),
    "current": ("current", pl.Boolean),
}


def project_dict(project: Project) -> dict[str, object]:
    """Return the JSON of a project: its data, its nodes, and the number of the current one."""
    model = project.node.kept.model
    return {
        "project": str(project.path),
        "data": project.source.to_dict(),
        "unit": model.torque_unit,
        "noise_floor": project.tree.noise_floor,
        "current": project.current,
        "model": model.spec,
        "nodes": [_node(node, project.tree) for node in project.tree],
    }


def project_frame(project: Project) -> pl.DataFrame:
    """Return a table with one row per node."""
    rows = [
        {**_node(n, project.tree), "current": n.number == project.current} for n in project.tree
    ]
    return pl.DataFrame(
        {column: [row[key] for row in rows] for column, (key, _) in COLUMNS.items()},
        schema={column: kind for column, (_, kind) in COLUMNS.items()},
    )


def _node(node: Node, tree: Tree) -> dict[str, object]:
    before = None if node.parent is None else tree.node(node.parent).kept
    found = node.found
    return {
        "node": node.number,
        "parent": node.parent,
        "change": node.change,
        "effect": node.effect,
        "name": node.name or None,
        "model": node.kept.model.spec,
        "rmse_before": None if before is None else before.rmse,
        "rmse_after": node.kept.rmse,
        "rmse_held_out_before": None if before is None else before.rmse_held_out,
        "rmse_held_out_after": node.kept.rmse_held_out,
        "confidence": None if found is None else found.confidence,
        "share_of_unexplained": None if found is None else found.share,
        "where": None if found is None else found.where,
        "indistinguishable_from": [] if found is None else list(found.ties),
        "rejected": dict(node.rejected),
        "diagnosis": None if node.diagnosis is None else node.diagnosis.to_dict(),
        "parameters": {
            name: {
                "symbol": e.symbol,
                "value": e.value,
                "unit": e.unit,
                "stderr": e.stderr,
                "at_bound": e.at_bound,
                "identifiable": e.identifiable,
            }
            for name, e in node.kept.estimates.items()
        },
    }
