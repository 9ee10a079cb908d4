"""Self-contained pages: everything a reader needs in one file, no network."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import jinja2
import numpy as np

from stribeck.base.files import png_bytes
from stribeck.effect.describe import physically
from stribeck.models.catalog import catalog
from stribeck.report.figures import improvement_figure
from stribeck.report.finding import finding_figure
from stribeck.report.numbers import DASH, change_text, confidence_words, percent, plain
from stribeck.report.text import (
    ALIKE,
    STOPPED,
    VISIBLE,
    diagnosis_summary,
    errors_sentence,
    explainable_text,
    file_name,
    group_rows,
    held_out_meaning,
    indistinguishable_sentence,
    left_after,
    left_text,
    parameter_rows,
    scored_sentence,
    step_errors,
    summary_sentence,
    unit_text,
    untestable_rows,
    visible_rows,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.diagnosis.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis, Finding
    from stribeck.diagnosis.testable import Untestable
    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording


@lru_cache(maxsize=1)
def _environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.PackageLoader("stribeck", "report/templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _facts(r: Recording) -> list[tuple[str, str]]:
    """What the recording is, as pairs of a name and a text."""
    duration = float(np.sum(r.dt))
    facts = [
        ("file", r.path),
        ("SHA-256", r.sha256),
        ("joint", f"{r.joint or 'not named'}, {r.joint_kind}"),
        ("rows", scored_sentence(r)),
        ("runs", str(r.runs)),
    ]
    if r.averaged:
        facts.append(("time", "one steady-state point a run"))
    else:
        facts.append(("time", f"{plain(duration)} s at {plain(r.rate_hz)} Hz, gaps: {r.gaps}"))
    for name, column in r.columns.items():
        if name == "time":
            continue
        span = ""
        if np.isfinite(column.minimum) and np.isfinite(column.maximum):
            unit = unit_text(column.unit)
            span = f"{plain(column.minimum)} to {plain(column.maximum)} {unit}"
        source = "" if column.source == name else f" (from {column.source})"
        facts.append((name.replace("_", " "), f"{span}{source}".strip()))
    return facts


def _steps(improvement: Improvement) -> list[dict[str, Any]]:
    errors = step_errors(improvement)
    known = [e for e in errors if e is not None]
    largest = max(known, default=1.0)
    rows = []
    before: float | None = None
    for k, error in enumerate(errors):
        step = improvement.steps[k - 1] if k else None
        f = step.after if step else improvement.base
        fall = ""
        if before and error is not None:
            fall = change_text(before, error)
        rows.append(
            {
                "label": f"+ {step.finding.effect}" if step else improvement.base.model.spec,
                "rmse": plain(f.rmse),
                "held_out": plain(error) if error is not None else DASH,
                "fall": fall,
                "confidence": confidence_words(step.finding.confidence) if step else "",
                "bar": 100.0 * error / largest if error is not None else 0.0,
            }
        )
        before = error
    return rows


def _finding(finding: Finding) -> dict[str, Any]:
    share = finding.share_of_unexplained
    return {
        "effect": finding.effect,
        "title": _title(finding.effect),
        "confidence": confidence_words(finding.confidence),
        "physically": physically(finding.effect, finding.fit.model),
        "where": finding.where[:1].upper() + finding.where[1:] + ".",
        "picture": picture_text(finding_figure(finding, headed=False)),
        "share": percent(share) if share is not None else None,
        "ties": indistinguishable_sentence(finding) if finding.indistinguishable_from else "",
    }


def picture_text(figure: Figure) -> str:
    """A figure as text that a page can hold."""
    return base64.b64encode(png_bytes(figure)).decode("ascii")


def _title(effect: str) -> str:
    """The catalog's title of an effect; an effect by formula goes by its name."""
    return str(catalog()["effects"].get(effect, {"title": effect})["title"])


def improvement_page(improvement: Improvement) -> str:
    """A page on one improvement: what was found, what it means, the figure and the numbers."""
    final = improvement.final
    floor = improvement.noise_floor
    largest = max([e for e in step_errors(improvement) if e is not None], default=1.0)
    return _page(
        "improvement.html",
        final,
        [step.finding for step in improvement.steps],
        improvement.untestable,
        summary=summary_sentence(improvement),
        picture=picture_text(improvement_figure(improvement)),
        steps=_steps(improvement),
        floor=None if floor.value is None else plain(floor.value),
        floor_at=None if floor.value is None else min(100.0 * floor.value / largest, 100.0),
        floor_why=floor.why,
        held_out=held_out_meaning(final.recording),
        stopped=STOPPED[improvement.stopped],
        left=left_text(improvement.unexplained),
        relative=None if final.relative_residual is None else percent(final.relative_residual),
    )


def diagnosis_page(diagnosis: Diagnosis) -> str:
    """A page on one diagnosis: each finding with its figure, what is left, what cannot be seen."""
    fitted = diagnosis.fit
    sentences = [
        errors_sentence(diagnosis),
        left_after(diagnosis),
        explainable_text(diagnosis.explainable, fitted.model.spec, fitted.model.torque_unit),
    ]
    lists = [
        (VISIBLE, visible_rows(diagnosis.smallest_visible)),
        (ALIKE, group_rows(diagnosis.groups)),
    ]
    return _page(
        "diagnosis.html",
        fitted,
        diagnosis.findings,
        diagnosis.untestable,
        summary=diagnosis_summary(diagnosis),
        left=[sentence for sentence in sentences if sentence],
        lists=[(heading, rows) for heading, rows in lists if rows],
    )


def _page(
    template: str,
    fitted: Fit,
    findings: Sequence[Finding],
    untestable: Iterable[Untestable],
    **said: Any,
) -> str:
    """A page with what all of them hold: the findings, the model, what the data cannot show."""
    r = fitted.recording
    return render(
        template,
        name=file_name(r),
        findings=[_finding(finding) for finding in findings],
        unit=fitted.model.torque_unit,
        spec=fitted.model.spec,
        parameters=parameter_rows(fitted.estimates.values()),
        untestable=untestable_rows(untestable),
        facts=_facts(r),
        notes=list(dict.fromkeys([*r.notes, *fitted.notes])),
        **said,
    )


def render(template: str, **said: Any) -> str:
    """A page from a template of this folder."""
    from stribeck.base.version import __version__

    return _environment().get_template(template).render(version=__version__, **said)
