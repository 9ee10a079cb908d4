"""A project as text and figure: the tree of models with their errors, and the current node."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.diagnosis.trials.trial import TIE
from stribeck.effect.describe import physically
from stribeck.report.comparison import comparison_figure, comparison_text
from stribeck.report.diagnosis import VERDICTS, less_likely_sentence
from stribeck.report.layout import (
    BAR,
    bar,
    bars_legend,
    bullets,
    joined,
    line_width,
    paragraph,
    table,
)
from stribeck.report.numbers import (
    DASH,
    change_text,
    confidence_words,
    listed,
    plain,
    unit_text,
    with_error,
)
from stribeck.report.parameters import parameters_text
from stribeck.report.residual import residual_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.projects.findings import Found
    from stribeck.projects.node import Node
    from stribeck.projects.project import Project
    from stribeck.projects.sides import Sides
    from stribeck.projects.tree import Tree

#: Marks the current node.
HERE = "▸"


def project_text(project: Project) -> str:
    """The whole project: tree, what was rejected, and the current node."""
    count = len(project.tree)
    joint = project.source.reading.get("joint")
    of = f"{Path(project.source.path).name}{f', {joint_called(joint)}' if joint else ''}"
    return joined(
        f"{project.path.name}: {count} model{'s' * (count != 1)} of {of}",
        "Held-out error of each node, and its change from the parent node:",
        tree_text(project),
        rejected_text(project),
        node_text(project),
    )


def project_figure(project: Project) -> Figure:
    """Residual of the base and of the current model against each channel."""
    numbers = (project.tree.root.number, project.current)
    return residual_figure([project.fit_of(n) for n in project.tree if n.number in numbers])


def sides_figure(sides: Sides) -> Figure:
    """Residual of both models against each channel."""
    return comparison_figure(sides.comparison)


def _error(node: Node) -> float:
    """The held-out error of a node, or its error where there is none."""
    kept = node.kept
    return kept.rmse if kept.rmse_held_out is None else kept.rmse_held_out


def branches(tree: Tree, number: int, before: str = "") -> list[tuple[Node, str]]:
    """The nodes in the order in which they are drawn, with the lines before their labels.

    A single child stands directly below its parent, as a step of the same branch; several children
    are indented, each as a branch.
    """
    node = tree.node(number)
    children = tree.children(number)
    drawn = []
    for k, child in enumerate(children):
        last = k == len(children) - 1
        lead = before if len(children) == 1 else f"{before}{'└ ' if last else '├ '}"
        below = before if len(children) == 1 else f"{before}{'  ' if last else '│ '}"
        drawn += [(child, lead), *branches(tree, child.number, below)[1:]]
    return [(node, before), *drawn]


def tree_text(project: Project) -> str:
    """A line a node: number, change, bar of the error, its fall, and the branch's name."""
    tree, unit = project.tree, project.node.kept.model.torque_unit
    floor = tree.noise_floor
    drawn = branches(tree, tree.root.number)
    largest = max([*(_error(node) for node in tree), floor or 0.0])
    labels = [f"{lead}{node.label}" for node, lead in drawn]
    wide = max(map(len, labels))
    digits = max(len(str(node.number)) for node in tree)
    lines = []
    for label, (node, _) in zip(labels, drawn, strict=True):
        mark = HERE if node.number == project.current else " "
        change = ""
        if node.parent is not None:
            change = f"  {change_text(_error(tree.node(node.parent)), _error(node))}"
        unseen = "" if node.kept.rmse_held_out is not None else " (not held out)"
        name = f"  {node.name!r}" if node.name else ""
        lines.append(
            f"{mark} {node.number:>{digits}}  {label:<{wide}}  "
            f"{bar(_error(node), largest, floor):<{BAR}}  {plain(_error(node))} {unit}"
            f"{unseen}{change}{name}"
        )
    if floor is not None:
        lines.append(f"{'':{digits + wide + 4}}  {bars_legend(floor, unit)}")
    return "\n".join(line.rstrip() for line in lines)


def rejected_text(project: Project) -> str:
    """The effects that are not tried, and why, node by node."""
    return bullets(
        "Rejected:",
        [
            f"{effect}, at node {node.number} and below it{f': {why}' if why else ''}."
            for node in project.tree
            for effect, why in node.rejected.items()
        ],
    )


def node_text(project: Project) -> str:
    """The current node: what was added, its parameters, and what is known to be missing."""
    node = project.node
    name = f", {node.name!r}" if node.name else ""
    return joined(
        f"{HERE} Node {node.number}: {node.kept.model.spec}{name}",
        change_sentence(project, node),
        parameters_text(node.kept.estimates),
        missing_text(project),
    )


def change_sentence(project: Project, node: Node) -> str:
    """What was added or dropped to make a node, how sure that is, and how the error changed."""
    if node.found is None or node.parent is None:
        return ""
    parent = project.tree.node(node.parent)
    before, after = _error(parent), _error(node)
    verb = "added to" if node.change == "add" else "dropped from"
    unit = node.kept.model.torque_unit
    sure = ""
    if node.found.confidence is not None:
        sure = f", {confidence_words(node.found.confidence)}"
    return "\n".join(
        [
            paragraph(
                f"{node.found.effect} {verb} node {parent.number}{sure}: error {plain(before)} → "
                f"{plain(after)} {unit} ({change_text(before, after)})."
            ),
            *_here(node.found, node if node.change == "add" else parent),
        ]
    )


def _here(found: Found, node: Node) -> list[str]:
    """What an effect is, and where the data shows it."""
    lines = [paragraph(physically(found.effect, node.kept.model))]
    if found.where:
        lines.append(paragraph(f"In this data: {found.where}."))
    return lines


def missing_text(project: Project) -> str:
    """What a diagnosis found at the current node, and what can be done next."""
    node, name = project.node, project.path.name
    said = node.diagnosis
    if said is None:
        return f"Not diagnosed yet: stribeck project diagnose {name}"
    lines = [VERDICTS[said.verdict]]
    rejected = project.tree.rejected(node.number)
    unit = node.kept.model.torque_unit
    for k, found in enumerate(said.findings):
        if k == 1 + len(said.findings[0].ties):
            likely = [said.findings[0].effect, *said.findings[0].ties]
            lines.append(paragraph(less_likely_sentence(likely), 0))
        done = project.tree.child(node.number, "add", found.effect)
        mark = ""
        if done is not None:
            mark = f" (added: node {done.number})"
        elif found.effect in rejected:
            mark = " (rejected)"
        sure = confidence_words(found.confidence) if found.confidence is not None else DASH
        error = (
            "" if found.rmse_held_out is None else f", error → {plain(found.rmse_held_out)} {unit}"
        )
        ties = f"; indistinguishable from {listed(found.ties, 'or')}" if found.ties else ""
        lines.append(paragraph(f"• {found.effect}{mark}: {sure}{error}{ties}.", 2, 2))
        lines.append(paragraph(f"{found.where}.", 4))
    if said.left is not None and said.left_where is not None:
        lines.append(paragraph(f"Unexplained structure remains: {said.left_where}.", 2))
    return "\n".join(lines)


def sides_text(sides: Sides) -> str:
    """Two nodes side by side: errors, whether they differ, parameters, and where each fails."""
    first, second = sides.nodes
    better, worse = sides.nodes[sides.better], sides.nodes[1 - sides.better]
    unit = first.kept.model.torque_unit
    statistic = sides.difference.statistic
    significance = "The errors are not significantly different on this data."
    if statistic > TIE:
        significance = f"The difference is significant: {statistic:.1f} standard errors."
    verdict = (
        f"Node {better.number} has the smaller held-out error, {plain(_error(better))} {unit}; "
        f"that of node {worse.number} is {plain(_error(worse))} {unit}. {significance}"
    )
    return joined(
        f"Node {first.number} ({first.kept.model.spec}) and node {second.number} "
        f"({second.kept.model.spec})",
        paragraph(verdict, 0),
        parameters_beside(first, second),
        comparison_text(sides.comparison),
    )


def parameters_beside(first: Node, second: Node) -> str:
    """The parameters of two nodes in one table."""
    columns = [node.kept.estimates for node in (first, second)]
    names = list(dict.fromkeys(name for column in columns for name in column))
    rows = [["parameter", f"node {first.number}", f"node {second.number}", "unit"]]
    for name in names:
        cells, unit = [], ""
        for column in columns:
            e = column.get(name)
            cells.append(DASH if e is None else _value(e.value, e.stderr))
            unit = unit if e is None else unit_text(e.unit)
        rows.append([textwrap.shorten(name, line_width() // 3), *cells, unit])
    return table(rows)


def _value(value: float, error: float | None) -> str:
    shown, doubt = with_error(value, error)
    return f"{shown} ± {doubt}" if doubt else shown
