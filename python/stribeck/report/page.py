"""Self-contained pages of an improvement and of a diagnosis: one file, no network."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stribeck.base.files import png_bytes
from stribeck.effect.describe import physically
from stribeck.models.catalog import catalog
from stribeck.report.diagnosis import (
    ALIKE,
    VISIBLE,
    diagnosis_summary,
    doubts,
    errors_sentence,
    explainable_after,
    floor_sentence,
    group_rows,
    indistinguishable_sentence,
    left_after,
    left_text,
    less_likely_sentence,
    likely_effects,
    untestable_rows,
    visible_rows,
)
from stribeck.report.finding import finding_figure
from stribeck.report.improvement import (
    passivity_sentence,
    step_errors,
    step_labels,
    stopped_sentence,
    summary_sentence,
)
from stribeck.report.improvement_figure import improvement_figure
from stribeck.report.numbers import (
    DASH,
    change_text,
    confidence_words,
    percent,
    plain,
    unit_text,
)
from stribeck.report.parameters import parameter_rows
from stribeck.report.recording import file_name, held_out_meaning, scored_sentence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis, Finding
    from stribeck.diagnosis.testable import Untestable
    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording


class StepRow(TypedDict):
    """A line of the table of steps."""

    label: str
    rmse: str
    held_out: str
    fall: str
    confidence: str
    bar: float


class FindingPart(TypedDict):
    """What a page says of a finding."""

    effect: str
    title: str
    confidence: str
    physically: str
    where: str
    picture: str
    share: str | None
    ties: str


def improvement_page(improvement: Improvement) -> str:
    """A page on one improvement: what was found, what it means, the figure and the numbers."""
    final, floor = improvement.final, improvement.noise_floor
    largest = max([e for e in step_errors(improvement) if e is not None], default=1.0)
    return _page(
        "improvement.html",
        final,
        [step.finding for step in improvement.steps],
        improvement.untestable,
        summary=summary_sentence(improvement),
        likely=len(improvement.steps),
        less_likely="",
        picture=picture_text(improvement_figure(improvement)),
        steps=_steps(improvement, largest),
        floor=floor_sentence(floor, final.model.torque_unit),
        floor_at=None if floor.value is None else min(100.0 * floor.value / largest, 100.0),
        held_out=held_out_meaning(final.recording),
        stopped=stopped_sentence(improvement),
        left=left_text(improvement.unexplained),
        relative=None if final.relative_residual is None else percent(final.relative_residual),
        passivity=passivity_sentence(improvement),
        lists=doubts(improvement.last),
    )


def diagnosis_page(diagnosis: Diagnosis) -> str:
    """A page on one diagnosis: each finding with its figure, what remains, what was not seen."""
    fitted = diagnosis.fit
    sentences = [
        errors_sentence(diagnosis),
        left_after(diagnosis),
        explainable_after(diagnosis),
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
        likely=len(likely_effects(diagnosis)),
        less_likely=less_likely_sentence(likely_effects(diagnosis)),
        left=[sentence for sentence in sentences if sentence],
        lists=[*doubts(diagnosis), *((heading, rows) for heading, rows in lists if rows)],
    )


def render(template: str, **said: object) -> str:
    """A page from a template of this room."""
    import jinja2

    from stribeck.base.version import __version__

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("stribeck", "report/templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(template).render(version=__version__, **said)


def picture_text(figure: Figure) -> str:
    """A figure as text that a page can hold."""
    return base64.b64encode(png_bytes(figure)).decode("ascii")


def _page(
    template: str,
    fitted: Fit,
    findings: Sequence[Finding],
    untestable: Iterable[Untestable],
    **said: object,
) -> str:
    """A page with what all of them hold: findings, parameters, what cannot be tested, the data."""
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


def _facts(r: Recording) -> list[tuple[str, str]]:
    """What the recording is, as pairs of a name and a text."""
    time = f"{plain(float(np.sum(r.dt)))} s at {plain(r.rate_hz)} Hz, gaps: {r.gaps}"
    facts = [
        ("file", r.path),
        ("SHA-256", r.sha256),
        ("joint", f"{r.joint or 'not named'}, {r.joint_kind}"),
        ("samples", scored_sentence(r)),
        ("runs", str(r.runs)),
        ("time", "one steady-state point a run" if r.averaged else time),
    ]
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


def _steps(improvement: Improvement, largest: float) -> list[StepRow]:
    labels, errors = step_labels(improvement), step_errors(improvement)
    fits = [improvement.base, *(step.after for step in improvement.steps)]
    sure = ["", *(confidence_words(step.finding.confidence) for step in improvement.steps)]
    rows: list[StepRow] = []
    for k, (label, error, fit) in enumerate(zip(labels, errors, fits, strict=True)):
        before = errors[k - 1] if k else None
        rows.append(
            {
                "label": label,
                "rmse": plain(fit.rmse),
                "held_out": DASH if error is None else plain(error),
                "fall": change_text(before, error) if before and error is not None else "",
                "confidence": sure[k],
                "bar": 0.0 if error is None else 100.0 * error / largest,
            }
        )
    return rows


def _finding(finding: Finding) -> FindingPart:
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


def _title(effect: str) -> str:
    """The catalog's title of an effect; an effect by formula goes by its name."""
    return str(catalog()["effects"].get(effect, {"title": effect})["title"])
