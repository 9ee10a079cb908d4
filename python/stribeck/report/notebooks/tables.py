"""What a notebook shows of results that are tables, with a figure where there is one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from markupsafe import Markup

from stribeck.report.diagnosis import untestable_rows
from stribeck.report.notebooks.results import cell, figures, view
from stribeck.report.numbers import listed, plain, thousands, unit_text
from stribeck.report.pages.equations import equations
from stribeck.report.pages.figures import robot_plots
from stribeck.report.pages.recording import picture_text
from stribeck.report.robot import (
    NO_CAUSES,
    added_rows,
    base_rows,
    bodies_sentence,
    causes_rows,
    errors_rows,
    gain_sentence,
    lacking_rows,
    plan_rows,
    plan_sentence,
)
from stribeck.report.robot_tracking import TRACKED, tracking_rows, tracking_sentence

if TYPE_CHECKING:
    from stribeck.base.shown import Shown
    from stribeck.diagnosis.inspect import Inspection
    from stribeck.models.model import Model
    from stribeck.passivity.certificate import Certificate
    from stribeck.projects.project import Project
    from stribeck.robot.diagnosis import RobotDiagnosis
    from stribeck.robot.follow import RobotTracking
    from stribeck.robot.improve import RobotImprovement
    from stribeck.robot.plan import RobotPlan
    from stribeck.robot.result import RobotFit


def model_view(model: Model) -> str:
    """A model: its equations and its values."""
    rows = [["parameter", "symbol", "value", "unit"]]
    rows += [
        [p.name, p.symbol, "" if math.isnan(value) else plain(value), unit_text(p.unit)]
        for p, value in zip(model.parameters, model.values, strict=True)
    ]
    parts = [
        [Markup("{}: {}").format(row.title, Markup(", ").join(row.statements) or row.text)]
        for row in equations(model)
    ]
    return view(model.spec, [[["equations"], *parts], rows])


def inspection_view(inspection: Inspection) -> str:
    """What files hold, whether the channels agree, and what they can show."""
    t = inspection.table
    joints = listed(t.joints) or "one"
    columns = [["channel", "from", "unit", "min", "max"]]
    columns += [
        [name, c.source, c.unit, plain(c.minimum), plain(c.maximum)]
        for name, c in t.channels.items()
    ]
    checks = [["check", "", "said"]]
    checks += [[c.check, "agrees" if c.ok else "contradiction", c.said] for c in inspection.checks]
    rows = untestable_rows(inspection.untestable.values())
    untestable = [["cannot be tested", "why", "to test it"], *map(list, rows)]
    problem = [] if inspection.problem is None else [inspection.problem]
    return view(
        f"{thousands(t.rows)} samples, runs: {t.runs}, joints: {joints}",
        [found for found in (columns, checks, untestable) if len(found) > 1],
        [*problem, f"Can be tested: {listed(inspection.testable) or 'no effect'}."],
        text=repr(inspection),
    )


def certificate_view(certificate: Certificate) -> str:
    """A proof of passivity or a counterexample: the box, and the margins."""
    box = [["channel", "from", "to"]]
    box += [[name, plain(low), plain(high)] for name, (low, high) in certificate.box.items()]
    summary, *_ = repr(certificate).split("\n\n")
    return view(summary, [box], text=repr(certificate))


def words_view(result: Shown) -> str:
    """A result of a few numbers: all in words, the first sentence before the others."""
    summary, *_ = repr(result).split("\n")
    return view(summary, text=repr(result))


def project_view(project: Project) -> str:
    """A project: its models, and the error of each."""
    frame = project.to_frame()
    rows = [frame.columns, *([cell(value) for value in row] for row in frame.rows())]
    picture = picture_text(project.plot())
    return view(project.path.name, [rows], text=repr(project), picture=picture)


def robot_fit_view(found: RobotFit) -> str:
    """The errors of each joint, the friction, and what is known of the rigid bodies."""
    name = found.solved.balance.base.robot.name
    shown = figures(robot_plots(found))
    return view(name, _fitted(found), [bodies_sentence(found)], text=repr(found), figures=shown)


def robot_improvement_view(found: RobotImprovement) -> str:
    """What every joint lacked, causes in the rigid bodies, and the robot with them."""
    added, causes = added_rows(found), causes_rows(found.rigid_body)
    sentences = [] if found.rigid_body else [NO_CAUSES]
    sentences += [] if len(added) > 1 else ["No effect is added."]
    return view(
        f"What the joints of {found.final.solved.balance.base.robot.name} lack",
        [rows for rows in (added, causes) if len(rows) > 1] + _fitted(found.final),
        [*sentences, bodies_sentence(found.final)],
        text=repr(found),
        figures=figures(robot_plots(found.final)),
    )


def robot_diagnosis_view(found: RobotDiagnosis) -> str:
    """What every joint lacks, and causes in the rigid bodies."""
    causes = causes_rows(found.rigid_body)
    tables = [rows for rows in (lacking_rows(found), causes) if len(rows) > 1]
    sentences = [] if found.rigid_body else [NO_CAUSES]
    name = found.fit.solved.balance.base.robot.name
    return view(f"What the joints of {name} lack", tables, sentences, text=repr(found))


def robot_plan_view(plan: RobotPlan) -> str:
    """The extent of a planned motion, and what it gains."""
    return view(plan_sentence(plan), [plan_rows(plan)], [gain_sentence(plan)], text=repr(plan))


def robot_tracking_view(tracked: RobotTracking) -> str:
    """The errors of every joint in closed loop."""
    tables = [tracking_rows(tracked)]
    return view(tracking_sentence(tracked), tables, [TRACKED], text=repr(tracked))


def _fitted(found: RobotFit) -> list[list[list[str]]]:
    """Errors of each joint, and base parameters."""
    return [errors_rows(found.joints, found.ordinary), base_rows(found)]
