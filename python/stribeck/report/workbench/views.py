"""What each page shows, as values for its template."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from stribeck.base.errors import spell_options
from stribeck.base.version import __version__
from stribeck.diagnosis.trials.trial import TIE
from stribeck.effect.describe import physically
from stribeck.effect.registry import of_catalog
from stribeck.models.catalog import catalog, effect_ids, law_ids
from stribeck.passivity.friction import friction_part
from stribeck.recording.check import Check
from stribeck.recording.naming.names import CHANNELS
from stribeck.recording.stated.options import TABLE, ReadOptions
from stribeck.report.certificate import certificate_parts
from stribeck.report.comparison import worst_places
from stribeck.report.diagnosis import (
    diagnosis_summary,
    doubts,
    errors_sentence,
    indistinguishable_sentence,
    likely_effects,
    untestable_rows,
)
from stribeck.report.finding_view import how_to_read
from stribeck.report.interactive.base import AXES_SPAN
from stribeck.report.numbers import change_text, confidence_words, percent, plain, thousands, typed
from stribeck.report.pages.prose import prose, unit
from stribeck.report.pages.recording import comparison_tables
from stribeck.report.parameters import parameter_rows
from stribeck.report.project import branches
from stribeck.report.recording import scored_sentence, state_of
from stribeck.report.unexplained import left_after
from stribeck.report.workbench.controller import PROJECT, Workbench

if TYPE_CHECKING:
    import jinja2

    from stribeck.diagnosis.result import Finding
    from stribeck.models.model import Model
    from stribeck.projects.node import Node
    from stribeck.recording.recording import Recording
    from stribeck.report.workbench.state import Joint

#: The pages in their order, with their titles.
PAGES = {
    "data": "Data",
    "check": "Check",
    "compare": "Compare",
    "where": "Where",
    "missing": "Missing",
    "add": "Add",
    "prove": "Prove",
    "export": "Export",
}
#: Laws that are offered first: what a newcomer compares.
USUAL = ("coulomb", "stribeck", "lugre", "dahl", "gms")
#: What is drawn of a planned motion.
PLANNED = ("position", "velocity", "acceleration")
#: Options of reading that most files need; the others are folded away.
FIRST = ("joint", "joint_kind", "map", "unit", "derive", "gear_ratio", "torque_constant", "where")
Link = Callable[..., str]
Values = dict[str, object]


def page(bench: Workbench, name: str, link: Link, drawn: str = "") -> str:
    """The HTML of a page, whose figures have the number `drawn`."""
    joint = bench.state.current
    values: Values = {
        "page": name,
        "pages": PAGES,
        "link": link,
        "drawn": drawn,
        "joint": joint,
        "joints": bench.state.joints,
        "project": None if joint is None else joint.project,
        "work": bench.work,
        "message": bench.state.message if bench.state.page in ("", name) else None,
        "state_version": bench.state.version,
        "version": __version__,
        "axes_span": AXES_SPAN,
        "folder": str(bench.folder),
        "figures": [],
        **_VIEWS[name](bench, joint),
    }
    return templates().get_template(f"{name}.html").render(**values)


def compile_pages() -> None:
    """Compile the templates of all pages, which their first visit would wait for."""
    for name in PAGES:
        templates().get_template(f"{name}.html")


@functools.cache
def templates() -> jinja2.Environment:
    """The templates of the pages, each compiled once."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("stribeck", "report/workbench/templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(prose=prose, unit=unit)
    return environment


def _data(bench: Workbench, joint: Joint | None) -> Values:
    projects = sorted(bench.folder.glob("*.project.toml")) if bench.folder.is_dir() else []
    known = [*bench.state.files, *(str(p) for p in projects if str(p) not in bench.state.files)]
    channels: list[str] = []
    if joint is not None and joint.recording is not None:
        r = joint.recording
        channels = ["time"]
        channels += ["velocity"]
        channels += ["position"] if r.position is not None else []
        channels += ["load"] if r.load_torque is not None else []
        channels += ["temperature"] if r.temperature is not None else []
    recordings = [path for path in known if not path.endswith(PROJECT)]
    return {
        "known": known,
        "recordings": recordings,
        "figures": channels,
        "scored": _scored(joint),
    }


def _scored(joint: Joint | None) -> str:
    if joint is None or joint.recording is None:
        return ""
    return scored_sentence(joint.recording)


def _check(bench: Workbench, joint: Joint | None) -> Values:
    found = None if joint is None else joint.looked
    said = {} if found is None else dict(found.said)
    options = ReadOptions() if joint is None else joint.options
    checks = cast("list[dict[str, Any]]", said.get("checks", []))
    return {
        "said": said,
        "columns": [] if found is None else found.columns,
        "channels": [name for name in CHANNELS if name not in ("joint", "run")],
        "checks": [
            {
                **row,
                "state": state_of(Check(**row)),
                "fixes": _fixes(str(row["do"] or "")),
                "said": bench.spell(str(row["said"])),
            }
            for row in checks
        ],
        "problem": bench.spell(str(said.get("problem", ""))),
        "fixes": _fixes(str(said.get("problem", ""))),
        "fields": [_field(entry.name, options) for entry in TABLE if entry.name in FIRST],
        "more": [
            _field(entry.name, options)
            for entry in TABLE
            if entry.name not in FIRST and entry.command_line
        ],
        "spell": bench.spell,
        "plain": plain,
        "thousands": thousands,
        "titles": _titles(),
        "untestable": _untestable_of(said),
    }


def _untestable_of(said: Values) -> list[tuple[str, str, str]]:
    rows = cast("list[dict[str, str]]", said.get("untestable", []))
    return [(row["effect"], row["why"], row["do"]) for row in rows]


def _fixes(sentence: str) -> list[tuple[str, str]]:
    """The options that a sentence proposes with values that can be taken as they are."""
    found: list[tuple[str, str]] = []

    def take(name: str, value: str | None) -> str:
        whole = value is not None and not any(w in value for w in ("COLUMN", "FORMULA", "FILE"))
        if any(entry.name == name for entry in TABLE) and (whole or value is None):
            switch = any(e.name == name and e.kind == "switch" for e in TABLE)
            if whole or switch:
                found.append((name, value or ""))
        return ""

    spell_options(sentence, take)
    return list(dict.fromkeys(found))


def _field(name: str, options: ReadOptions) -> Values:
    entry = next(entry for entry in TABLE if entry.name == name)
    given = getattr(options, name)
    shown = ""
    if entry.kind == "pairs":
        shown = "\n".join(f"{k}={v}" for k, v in options.pairs(name).items())
    elif given is not None and given is not False:
        shown = str(given)
    return {"entry": entry, "label": name.replace("_", " "), "value": shown}


def _compare(bench: Workbench, joint: Joint | None) -> Values:
    laws = None if joint is None else joint.laws
    sides = None if joint is None else joint.sides
    return {
        "usual": [law for law in USUAL if law in law_ids()],
        "laws": law_ids(),
        "titles": {law: str(catalog()["laws"][law]["title"]) for law in law_ids()},
        "shown": None if laws is None else comparison_tables(laws),
        "sides": None if sides is None else comparison_tables(sides.comparison),
        "verdict": None if sides is None else sides_sentence(joint),
        "nodes": _nodes(joint),
        "chosen": () if sides is None else tuple(node.number for node in sides.nodes),
        "figures": _sample_figures(joint) if sides is not None else [],
    }


def sides_sentence(joint: Joint | None) -> str:
    """Which of two models is better, and whether that is more than chance."""
    sides = None if joint is None else joint.sides
    if sides is None:
        return ""
    better = sides.nodes[sides.better]
    between = sides.difference.statistic
    chance = "" if between > TIE else ", which may be chance"
    return (
        f"Node {better.number}, {better.kept.model.spec}, has the smaller held-out error; the "
        f"difference is {plain(between, 2)} standard errors{chance}."
    )


def _where(bench: Workbench, joint: Joint | None) -> Values:
    comparison = None if joint is None else joint.comparison
    if joint is None or joint.project is None or comparison is None:
        return {"shown": None, "figures": []}
    return {
        "shown": comparison_tables(comparison),
        "places": worst_places(comparison.models[0]),
        "parameters": parameter_rows(joint.project.node.kept.estimates.values()),
        "figures": [*_sample_figures(joint), "intervals", "correlation"],
    }


def _sample_figures(joint: Joint | None) -> list[str]:
    if joint is None or joint.recording is None:
        return []
    r = joint.recording
    names = ["time", "residual", "friction", "against velocity"]
    names += ["loop position", "against position"] if r.position is not None else []
    names += ["against load"]
    names += ["against temperature"] if r.temperature is not None else []
    return [*names, "against acceleration", "loop reversal", "against reversal"]


def _missing(bench: Workbench, joint: Joint | None) -> Values:
    project = None if joint is None else joint.project
    kept = None if project is None else project.node.diagnosis
    full = None if project is None else project.diagnosis
    if project is None or kept is None:
        return {"kept": None, "full": None, "found": [], "figures": []}
    rejected = project.tree.rejected(project.current)
    if full is None:
        return {"kept": kept, "full": None, "found": [], "figures": [], "rejected": rejected}
    likely = likely_effects(full)
    return {
        "kept": kept,
        "full": full,
        "summary": diagnosis_summary(full),
        "errors": errors_sentence(full),
        "left": left_after(full),
        "found": [_finding(f, f.effect in likely) for f in full.findings],
        "doubts": doubts(full),
        "untestable": untestable_rows(full.untestable),
        "rejected": rejected,
        "figures": ["findings", "time"] if full.findings else [],
    }


def _finding(finding: Finding, likely: bool) -> Values:
    ties = indistinguishable_sentence(finding) if finding.indistinguishable_from else ""
    share = finding.share_of_unexplained
    unit = finding.fit.model.torque_unit
    before, after = finding.rmse_held_out_before, finding.rmse_held_out_after
    return {
        "effect": finding.effect,
        "title": _titles().get(finding.effect, finding.effect),
        "likely": likely,
        "confidence": confidence_words(finding.confidence),
        "physically": physically(finding.effect, finding.fit.model),
        "where": f"{finding.where[:1].upper()}{finding.where[1:]}.",
        "falls": f"{plain(before)} → {plain(after)} {unit} ({change_text(before, after)})",
        "share": "" if share is None else percent(share),
        "ties": ties,
        "read": "; ".join(how_to_read(finding.effect)),
    }


def _add(bench: Workbench, joint: Joint | None) -> Values:
    project = None if joint is None else joint.project
    if project is None:
        return {"nodes": [], "figures": [], "effects": [], "own": [], "rejected": {}}
    model = project.node.kept.model
    return {
        "nodes": _nodes(joint),
        "effects": [(e, _titles()[e]) for e in effect_ids() if not model.has(e)],
        "own": [*model.own_effects, *model.effects],
        "rejected": project.tree.rejected(project.current),
        "figures": ["errors"],
    }


def _nodes(joint: Joint | None) -> list[Values]:
    """The tree in the order in which it is drawn."""
    if joint is None or joint.project is None:
        return []
    project = joint.project
    return [_node(joint, node, lead) for node, lead in branches(project.tree, 0)]


def _node(joint: Joint, node: Node, lead: str) -> Values:
    assert joint.project is not None
    kept, tree = node.kept, joint.project.tree
    error = kept.rmse if kept.rmse_held_out is None else kept.rmse_held_out
    change = ""
    if node.parent is not None:
        before = tree.node(node.parent).kept
        change = change_text(before.rmse_held_out or before.rmse, error)
    return {
        "number": node.number,
        "lead": lead,
        "label": node.label,
        "spec": kept.model.spec,
        "name": node.name,
        "error": f"{plain(error)} {kept.model.torque_unit}",
        "change": change,
        "current": node.number == joint.project.current,
    }


def _prove(bench: Workbench, joint: Joint | None) -> Values:
    project = None if joint is None else joint.project
    empty: Values = {"certificate": None, "figures": [], "box": "", "planned": None}
    if joint is None or project is None:
        return empty
    r, model = project.recording, project.node.kept.model
    fastest = float(abs(r.velocity).max())
    hardest = float(abs(r.acceleration_smooth).max())
    rows = () if project.diagnosis is None else project.diagnosis.untestable
    read = friction_part(model)[0].core.needs
    return {
        "certificate": None if joint.certificate is None else certificate_parts(joint.certificate),
        "passive": None if joint.certificate is None else joint.certificate.passive,
        "box": "\n".join(
            f"{k}={low:.4g}:{high:.4g}" for k, (low, high) in model.box.items() if k in read
        ),
        "unit": r.position_unit,
        "low": typed(-1.0 if r.position is None else float(r.position.min())),
        "high": typed(1.0 if r.position is None else float(r.position.max())),
        "speed": typed(fastest),
        "acceleration": typed(hardest),
        "effects": [e for e in effect_ids() if not model.has(e)],
        "unseen": [row.effect for row in rows if _can_be_planned(row.effect, model, r)],
        "planned": None if joint.plan is None else bench.spell(repr(joint.plan)),
        "figures": [] if joint.plan is None else [f"planned {name}" for name in PLANNED],
    }


def _can_be_planned(effect: str, model: Model, recording: Recording) -> bool:
    """Whether a motion can show the effect beside a model: not if that lacks what it acts on."""
    own = of_catalog(effect)
    if own.shown_beside is None:
        return True
    return own.refusal(model.with_effect(effect, {}), recording) is None


def _export(bench: Workbench, joint: Joint | None) -> Values:
    written: Iterable[Path] = bench.state.written
    return {"written": [(k, str(p)) for k, p in enumerate(written)], "figures": []}


def _titles() -> dict[str, str]:
    return {name: str(row["title"]) for name, row in catalog()["effects"].items()}


_VIEWS: dict[str, Callable[[Workbench, Joint | None], Values]] = {
    "data": _data,
    "check": _check,
    "compare": _compare,
    "where": _where,
    "missing": _missing,
    "add": _add,
    "prove": _prove,
    "export": _export,
}
