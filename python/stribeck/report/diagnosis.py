"""A diagnosis as text and figure: what is missing, what remains, what cannot be tested."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from stribeck.effect.describe import physically
from stribeck.models.catalog import effect_row
from stribeck.report.channels import torque_name
from stribeck.report.comparison import noise_floor_sentence
from stribeck.report.layout import bullets, joined, notes_text, paragraph
from stribeck.report.numbers import (
    POSSIBLE,
    confidence_text,
    confidence_words,
    hedge,
    listed,
    percent,
    plain,
)
from stribeck.report.recording import file_name, held_out_meaning
from stribeck.report.residual import residual_figure
from stribeck.report.unexplained import left_after

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stribeck.diagnosis.residual.explainable import Explainable
    from stribeck.diagnosis.residual.noise_floor import NoiseFloor
    from stribeck.diagnosis.result import Diagnosis, Finding, Pair
    from stribeck.diagnosis.testable import Untestable
    from stribeck.diagnosis.trend import Trend
    from stribeck.diagnosis.visibility.result import Group, SmallestVisible

#: With fewer samples hardly any effect can be significant.
FEWEST = 300
VERDICTS = {
    "missing": "Missing:",
    "none": "Nothing is missing: the residual is noise.",
    "unexplained": "Unexplained structure remains, but none of the known effects explains it.",
}
#: The verdict where nothing is found, and it is not known how much of the error is noise.
NONE_SHOWN = "No effect that this recording can show is missing."
#: The verdict where effects lower the held-out error, and none may be claimed.
NO_CLAIM = "Effects lower the held-out error, but none of them can be claimed on this recording."
#: Headings of the lists of a diagnosis.
DEMOTED = "Lowers the held-out error, but this recording does not show it well enough"
NOT_CLAIMED = "Lowers the held-out error, but cannot be the cause, or need not be"
ALIKE = "Indistinguishable from each other on this data"


def diagnosis_text(diagnosis: Diagnosis) -> str:
    """What is missing from a model."""
    f = diagnosis.fit
    findings = [finding_text(finding, k) for k, finding in enumerate(diagnosis.findings, 1)]
    likely = len(likely_effects(diagnosis))
    following = ""
    if findings:
        following = (
            f"Each effect was tried alone. Add {diagnosis.findings[0].effect} and diagnose again "
            f"(`improve` does this): the answer for the other effects can change."
        )
    return joined(
        f"What is missing from {f.model.spec} on {file_name(f.recording)}?",
        paragraph(errors_sentence(diagnosis)),
        joined(_verdict(diagnosis), *findings[:likely]),
        joined(paragraph(less_likely_sentence(likely_effects(diagnosis)), 0), *findings[likely:])
        if findings[likely:]
        else "",
        paragraph(left_after(diagnosis), 0),
        paragraph(explainable_after(diagnosis), 0),
        paragraph(trend_text(diagnosis.trend), 0),
        paragraph(pair_sentence(diagnosis.pair), 0),
        paragraph(following, 0),
        bullets(f"{visible_heading(diagnosis)}:", visible_rows(diagnosis.smallest_visible)),
        bullets(f"{ALIKE}:", group_rows(diagnosis.groups)),
        doubts_text(diagnosis),
        untestable_text(diagnosis.untestable),
        notes_text(f.recording.notes, f.notes),
    )


def _verdict(diagnosis: Diagnosis) -> str:
    """The verdict as a heading, in proportion to the confidence."""
    if not diagnosis.findings and diagnosis.has_doubts:
        return NO_CLAIM
    if diagnosis.verdict == "none" and diagnosis.unexplained.share is None:
        return _too_few(diagnosis) or NONE_SHOWN
    said = VERDICTS[diagnosis.verdict]
    word = hedge(diagnosis.findings[0].confidence) if diagnosis.findings else ""
    return f"{word.capitalize()} {said[0].lower()}{said[1:]}" if word else said


def pair_sentence(pair: Pair | None) -> str:
    """Which two effects predict only together; an empty string where none do."""
    if pair is None:
        return ""
    return (
        f"Together, {pair.first.effect} and {pair.second} lower the held-out error by "
        f"{percent(pair.fall)}, and no effect nearly as much alone: two missing causes may hide "
        f"each other. `improve` adds both if they pass all tests."
    )


def doubts_text(diagnosis: Diagnosis) -> str:
    """Effects that lower the held-out error, but are demoted or not claimed, and why."""
    return joined(*(bullets(f"{heading}:", rows) for heading, rows in doubts(diagnosis)))


def doubts(diagnosis: Diagnosis) -> list[tuple[str, list[str]]]:
    """The same as headings with a sentence for each effect; nothing where there is no effect."""
    demoted = [
        f"{row.effect} (confidence {confidence_text(row.confidence)}): {row.demoted}."
        for row in diagnosis.demoted
    ]
    refused = [f"{row.effect}: {row.reason}." for row in diagnosis.unclaimed]
    return [row for row in ((DEMOTED, demoted), (NOT_CLAIMED, refused)) if row[1]]


def diagnosis_figure(diagnosis: Diagnosis) -> Figure:
    """Residual against each channel, without the first finding and with it."""
    after = [diagnosis.findings[0].fit] if diagnosis.findings else []
    return residual_figure([diagnosis.fit, *after])


def diagnosis_summary(diagnosis: Diagnosis) -> str:
    """What a diagnosis found, in one sentence."""
    spec, unit = diagnosis.fit.model.spec, diagnosis.fit.model.torque_unit
    if not diagnosis.findings:
        return nothing_found(diagnosis, spec, unexplained=diagnosis.unexplained.is_structure)
    best = diagnosis.findings[0]
    return (
        f"What the model {spec} lacks most is {hedged(best)}: adding it lowers the held-out error "
        f"from {plain(best.rmse_held_out_before)} to {plain(best.rmse_held_out_after)} {unit}."
    )


def hedged(finding: Finding, word: str | None = None) -> str:
    """The effect of a finding; one that is not sure with `word` before it and what speaks against.

    Parameters
    ----------
    word
        Default: what the confidence demands.
    """
    word = hedge(finding.confidence) if word is None else word
    others = listed(finding.indistinguishable_from, "or")
    ties = f"this motion cannot tell it from {others}" if others else ""
    if not hedge(finding.confidence):
        return f"{finding.effect} ({ties})" if ties else finding.effect
    said = "; ".join(filter(None, (confidence_text(finding.confidence), ties)))
    return f"{word} {finding.effect} ({said})".strip()


def nothing_found(last: Diagnosis, spec: str, *, unexplained: bool) -> str:
    """That no effect was found or added, and whether something remains unexplained."""
    if last.findings:
        return (
            f"No effect was added to the model {spec}, as none may be; what it lacks most is "
            f"{hedged(last.findings[0])}."
        )
    if last.trend is not None:
        return (
            f"No effect is claimed to be missing from the model {spec}, but {_changes(last.trend)}."
        )
    if last.has_doubts and not unexplained:
        return (
            f"No effect is claimed to be missing from the model {spec}: what lowers its held-out "
            f"error need not be the cause."
        )
    if last.has_doubts:
        return (
            f"The model {spec} leaves more than noise on this recording, but no effect that lowers "
            f"its held-out error can be claimed."
        )
    if unexplained:
        return (
            f"The model {spec} leaves unexplained structure on this recording, but no known effect "
            f"lowers its held-out error significantly."
        )
    none = f"No effect that this recording can show is missing from the model {spec}."
    return _too_few(last) or none


def _too_few(last: Diagnosis) -> str:
    """That the recording says little, where few of its samples are fitted to."""
    count = last.fit.rows.size
    if count >= FEWEST or last.fit.recording.averaged:
        return ""
    return (
        f"This recording says little about what the model {last.fit.model.spec} lacks: only "
        f"{count} samples can be fitted, in which the joint moves clearly faster than the noise of "
        f"its velocity."
    )


def likely_effects(diagnosis: Diagnosis) -> list[str]:
    """The first finding and those indistinguishable from it; the others follow them."""
    if not diagnosis.findings:
        return []
    best = diagnosis.findings[0]
    return [best.effect, *best.indistinguishable_from]


def less_likely_sentence(likely: Sequence[str]) -> str:
    """Heading of the findings that the likely effects make improbable."""
    return (
        f"Added instead of {listed(list(likely), 'or')}, each of these also lowers the held-out "
        f"error, but is less likely to be the cause:"
    )


def finding_text(finding: Finding, number: int | None = None) -> str:
    """One finding: what, how sure, its physics, where it shows, what it brings."""
    unit = finding.fit.model.torque_unit
    share = ""
    if finding.share_of_unexplained is not None:
        explained = percent(finding.share_of_unexplained)
        share = f". It explains {explained} of the squared error above the noise floor"
    lead = "" if number is None else f"{number}. "
    parts = [
        f"  {lead}{finding.effect}: {confidence_words(finding.confidence)}",
        paragraph(physically(finding.effect, finding.fit.model), 5),
        paragraph(f"In this data: {finding.where}.", 5),
        paragraph(
            f"Held-out error {plain(finding.rmse_held_out_before)} → "
            f"{plain(finding.rmse_held_out_after)} {unit}{share}. {carried_sentence(finding)}",
            5,
        ),
    ]
    if finding.part < min(finding.weight, finding.certainty):
        parts.append(paragraph("The structure that remains limits this confidence.", 5))
    if finding.indistinguishable_from and round(finding.confidence, 2) >= POSSIBLE:
        parts.append(paragraph(indistinguishable_sentence(finding), 5))
    return "\n".join(parts)


def carried_sentence(finding: Finding) -> str:
    """Which part of the data carries a finding."""
    carried = finding.carried
    events = "points" if finding.fit.recording.averaged else "moves"
    return (
        f"{percent(carried.share)} of the samples and {carried.events} {events} carry 90 % of that."
    )


def indistinguishable_sentence(finding: Finding) -> str:
    """Which other effects may be the cause as well."""
    others = finding.indistinguishable_from
    said = f"Indistinguishable from {listed(others, 'or')} on this data."
    own = _parameters(finding.effect)
    if any(_parameters(other) < own for other in others):
        return said
    return f"{said} Of effects that predict equally well, the simplest is listed first."


def _parameters(effect: str) -> int:
    """The number of parameters of an effect of the catalog; of a formula 0."""
    row = effect_row(effect)
    return 0 if row is None else len(row["parameters"])


def errors_sentence(diagnosis: Diagnosis) -> str:
    """The held-out error and the noise floor."""
    f = diagnosis.fit
    noise = floor_sentence(diagnosis.noise_floor, f.model.torque_unit)
    if f.rmse_held_out is None:
        return noise
    meaning = held_out_meaning(f)
    return f"Held-out error {plain(f.rmse_held_out)} {f.model.torque_unit} ({meaning}). {noise}"


def floor_sentence(floor: NoiseFloor, unit: str) -> str:
    """The noise floor, or why there is none."""
    if floor.value is None:
        return f"The noise floor cannot be estimated: {floor.why}."
    return noise_floor_sentence(floor.value, unit)


def trend_text(found: Trend | None) -> str:
    """What changes along the recording, and what would tell why."""
    if found is None:
        return ""
    said = _changes(found)
    said = f"{said[0].upper()}{said[1:]}"
    if found.cause == "gain":
        return (
            f"{said}: all by the same share, so it is the gain of the motor torque (magnets weaken "
            f"with heat) rather than friction."
        )
    if found.cause == "load":
        return (
            f"{said}, and friction not clearly: the payload may have changed. Give the load "
            f"torque, or diagnose each payload alone."
        )
    if found.cause == "zero":
        return (
            f"{said}, which explains it as well; friction does not change clearly. Compare the "
            f"torque at rest at the same position before and after, without a payload."
        )
    return (
        f"{said}. No temperature was recorded: this may be temperature, wear or run-in. Record the "
        f"temperature to tell."
    )


def _changes(found: Trend) -> str:
    """Which parts change along the recording, and by how much."""
    shown = [
        f"{name} {'rises' if change.share > 0.0 else 'falls'} by {percent(abs(change.share))} "
        f"(± {percent(change.stderr)})"
        for name, change in found.changes.items()
        if change.clear
    ]
    said = f"over the {plain(found.seconds)} s of the recording {listed(shown)}"
    return f"{said}, or the zero of the torque drifts" if found.cause == "zero" else said


def explainable_text(explainable: Explainable | None, spec: str, unit: str) -> str:
    """How much of the error of the best model the channels could still explain.

    Parameters
    ----------
    spec
        The best model: the regressor learns its residual.
    """
    if explainable is None:
        return ""
    regressor = f"A flexible regressor without physics, fitted to the residual of {spec},"
    if explainable.left <= 0.0:
        return f"{regressor} does not lower its held-out error."
    return (
        f"{regressor} removes {percent(explainable.left)} of its squared held-out error, which "
        f"leaves {plain(explainable.rmse)} {unit}."
    )


def explainable_after(diagnosis: Diagnosis) -> str:
    """The same for a diagnosis, once the first finding is added."""
    best = diagnosis.findings[0].fit if diagnosis.findings else diagnosis.fit
    return explainable_text(diagnosis.explainable, best.model.spec, best.model.torque_unit)


def untestable_rows(rows: Iterable[Untestable]) -> list[tuple[str, str, str]]:
    """Effects with the same reason together: (effects, why, do)."""
    grouped: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        grouped.setdefault((row.why, row.do), []).append(row.effect)
    return [(listed(names), why, do) for (why, do), names in grouped.items()]


def untestable_text(rows: Iterable[Untestable], indent: int = 0) -> str:
    """Effects that the data cannot test, why, and what would."""
    return bullets(
        "Cannot be tested with this data:",
        [f"{names}: {why}. To test: {do}." for names, why, do in untestable_rows(rows)],
        indent,
    )


def visible_heading(diagnosis: Diagnosis) -> str:
    """Heading of the list of the effects that were not found."""
    effort = torque_name(diagnosis.fit.model.torque_unit)
    return f"Not found. Smallest RMS {effort} that would have been significant 19 times in 20"


def visible_rows(rows: Sequence[SmallestVisible]) -> list[str]:
    """From which size on each effect would have been found, similar sizes together."""
    bands: list[list[SmallestVisible]] = []
    for row in sorted(rows, key=lambda row: row.rms):
        if not bands or row.rms > 1.5 * bands[-1][0].rms:
            bands.append([])
        bands[-1].append(row)
    return [f"{plain(b[-1].rms, 2)} {b[-1].unit}: {listed([r.effect for r in b])}." for b in bands]


def group_rows(groups: Sequence[Group]) -> list[str]:
    """Effects that are indistinguishable on this data, and below which size."""
    return [
        listed(group.effects)
        + (f", below {plain(group.rms, 2)} {group.unit} RMS" if math.isfinite(group.rms) else "")
        + "."
        for group in groups
    ]
