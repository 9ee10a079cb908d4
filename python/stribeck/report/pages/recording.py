"""Self-contained pages on one recording and its models: one file, no network."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypedDict

import numpy as np

from stribeck.base.files import png_bytes
from stribeck.effect.describe import physically
from stribeck.models.catalog import catalog
from stribeck.report.certificate import certificate_parts
from stribeck.report.channels import torque_name
from stribeck.report.comparison import MARKED, REGIMES_LEGEND, compared, criteria, overview_rows
from stribeck.report.diagnosis import less_likely_sentence, untestable_rows
from stribeck.report.finding_view import how_to_read
from stribeck.report.fit import ASSUMED, PASSIVITY
from stribeck.report.interactive.base import AXES_SPAN
from stribeck.report.interactive.decimate import MOST_DRAWN
from stribeck.report.numbers import (
    DASH,
    change_text,
    confidence_words,
    listed,
    percent,
    plain,
    signed,
    thousands,
    unit_text,
)
from stribeck.report.pages.account import Account, Step, error_of, of_diagnosis, of_improvement
from stribeck.report.pages.equations import beside, equations, symbols
from stribeck.report.pages.figures import Figures, account_plots, figures_of
from stribeck.report.pages.prose import prose, unit
from stribeck.report.pages.sections import Section, numbers
from stribeck.report.pages.versions import versions
from stribeck.report.parameters import interval_text, parameter_rows
from stribeck.report.recording import (
    REGIMES,
    file_name,
    held_out_meaning,
    scored_sentence,
    state_of,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.diagnosis.compare import Comparison
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis
    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording


class StepPart(TypedDict):
    """What a page says of a step or a finding."""

    number: int
    effect: str
    title: str
    confidence: str
    physically: str
    where: str
    share: str
    ties: str
    read: str
    before: str
    after: str
    change: str
    model: str


def improvement_page(improvement: Improvement) -> str:
    """A page on one improvement: what was found, what it means, the figures and the numbers."""
    return account_page(of_improvement(improvement))


def diagnosis_page(diagnosis: Diagnosis) -> str:
    """A page on one diagnosis: each finding with its figure, what remains, what was not seen."""
    return account_page(of_diagnosis(diagnosis))


def account_page(account: Account, spell: Callable[[str], str] = str) -> str:
    """A page on a recording and its models, with figures that can be zoomed and selected in.

    Parameters
    ----------
    spell
        Writes the options in its sentences.
    """
    final = account.final
    r, torque_unit = final.recording, final.model.torque_unit
    found = bool(account.steps) and account.steps[0].verb == "found"
    return render(
        "report.html",
        name=file_name(r),
        summary=account.summary,
        figures=figures_of(account_plots(account)),
        unit=torque_unit,
        quantity=torque_name(torque_unit),
        steps=[_step(k, step) for k, step in enumerate(account.steps, 1)],
        found=found,
        likely=account.likely,
        less_likely=less_likely_sentence([s.effect for s in account.steps[: account.likely]]),
        comparison=None if account.comparison is None else comparison_tables(account.comparison),
        shown=[fit.model.spec for fit in account.models],
        spec=final.model.spec,
        equations=equations(final.model),
        symbols=symbols(final.model),
        beside=beside(final.model),
        parameters=parameter_table(final),
        errors=_errors_sentence(final),
        held_out=held_out_meaning(final),
        untestable=[tuple(map(spell, row)) for row in untestable_rows(account.untestable)],
        left=account.left,
        lists=account.lists(),
        passivity=_passivity(account),
        facts=_facts(r),
        channels=_channels(r),
        checks=[(state_of(c), spell(c.said), spell(c.do or "")) for c in r.checks],
        notes=[spell(note) for note in dict.fromkeys([*r.notes, *final.notes])],
        command=account.command,
        versions=versions(),
        drawn_note=_drawn_sentence(account),
        axes_span=AXES_SPAN,
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
    environment.filters.update(prose=prose, unit=unit)
    return environment.get_template(template).render(version=__version__, **said)


def sections_page(
    name: str,
    about: str,
    summary: str,
    figures: Figures,
    sections: Sequence[Section],
    command: str,
    *,
    beside: Sequence[str] = (),
    first: Sequence[Section] = (),
) -> str:
    """A page that is made of tables, with its figures above them.

    Parameters
    ----------
    about
        What the title of the window says beside the name.
    beside
        Sentences in small letters below the summary.
    first
        Sections above the figures.
    """
    return render(
        "sections.html",
        name=name,
        about=about,
        summary=summary,
        beside=beside,
        first=first,
        figures=figures,
        sections=sections,
        command=command,
        versions=versions(),
        numbers=numbers,
    )


def picture_text(figure: Figure) -> str:
    """A figure as text that a page can hold."""
    return base64.b64encode(png_bytes(figure)).decode("ascii")


def _facts(r: Recording) -> list[tuple[str, str]]:
    """What the recording is, as pairs of a name and a text."""
    time = f"{plain(float(np.sum(r.dt)))} s at {plain(r.rate_hz)} Hz, gaps: {r.gaps}"
    return [
        ("file", r.path),
        ("SHA-256", r.sha256),
        ("joint", f"{r.joint or 'not named'}, {r.joint_kind}"),
        ("samples", prose(scored_sentence(r))),
        ("runs", str(r.runs)),
        ("time", "one steady-state point a run" if r.averaged else time),
    ]


def _channels(r: Recording) -> list[tuple[str, str, str, str, str]]:
    """Each channel: name, from where, unit, smallest and largest value."""
    return [
        (
            name.replace("_", " "),
            column.source,
            unit_text(column.unit),
            plain(column.minimum) if np.isfinite(column.minimum) else DASH,
            plain(column.maximum) if np.isfinite(column.maximum) else DASH,
        )
        for name, column in r.columns.items()
    ]


def comparison_tables(comparison: Comparison) -> dict[str, object]:
    """Tables of models side by side, and of where each fails."""
    models = comparison.models
    heading, *rows = overview_rows(comparison)
    regimes = [
        (
            REGIMES[regime.regime],
            percent(regime.share),
            [
                (
                    plain(a.regimes[k].rmse),
                    signed(a.regimes[k].bias, a.regimes[k].rmse),
                    regime.regime != "standstill" and a.regimes[k].rmse > MARKED * a.rmse,
                )
                for a in models
            ],
        )
        for k, regime in enumerate(models[0].regimes)
    ]
    return {
        "heading": heading,
        "unit": models[0].fit.model.torque_unit,
        "rows": rows,
        "names": [a.model for a in models],
        "regimes": regimes,
        "legend": REGIMES_LEGEND,
        "held_out": compared(comparison),
        "criteria": criteria(models).strip(),
    }


def _step(number: int, step: Step) -> StepPart:
    before, after = error_of(step.before), error_of(step.after)
    sure = "" if step.confidence is None else confidence_words(step.confidence)
    model = step.before.model if step.verb == "drop" else step.after.model
    ties = f"On this data it cannot be told from {listed(step.ties, 'or')}." if step.ties else ""
    return {
        "number": number,
        "effect": step.effect,
        "title": f"{_title(step.effect)}{' dropped' if step.verb == 'drop' else ''}",
        "confidence": sure,
        "physically": physically(step.effect, model),
        "where": f"{step.where[:1].upper()}{step.where[1:]}." if step.where else "",
        "share": "" if step.share is None else percent(step.share),
        "ties": ties,
        "read": "; ".join(how_to_read(step.effect)),
        "before": plain(before),
        "after": plain(after),
        "change": change_text(before, after),
        "model": step.after.model.spec,
    }


def _errors_sentence(fit: Fit) -> str:
    """What standard errors mean, where there are some."""
    if all(e.stderr is None for e in fit.estimates.values()):
        return ""
    return (
        f"\u00b1 is one standard error, {ASSUMED[fit.errors]}. It does not account for effects "
        "that the model lacks."
    )


def parameter_table(fit: Fit) -> list[list[str]]:
    """The rows of the table of parameters, with the interval after the standard error."""
    rows = parameter_rows(fit.estimates.values())
    return [
        [*row[:4], interval_text(e), *row[4:]]
        for row, e in zip(rows, fit.estimates.values(), strict=True)
    ]


def _passivity(account: Account) -> list[tuple[str, list[str]]]:
    """The proof, or the answer alone: sentences, each with the items that are listed below it."""
    answer = PASSIVITY[account.final.passive()]
    if account.certificate is None:
        return [(account.passivity or answer, [])]
    made = [(part.sentence, part.rows) for part in certificate_parts(account.certificate)]
    cost = account.passivity.removeprefix(answer).strip()
    return [*made, (cost, [])] if cost else made


def _drawn_sentence(account: Account) -> str:
    """How many of the samples the figures show."""
    count = account.final.recording.rows
    if count <= MOST_DRAWN:
        return ""
    return (
        f"Figures show at most {thousands(MOST_DRAWN)} of the {thousands(count)} samples: the "
        "first and the extremes of equal stretches. Medians and bands are those of all samples."
    )


def _title(effect: str) -> str:
    """The catalog's title of an effect; an effect by formula goes by its name."""
    return str(catalog()["effects"].get(effect, {"title": effect})["title"])
