"""Everything that a page on one recording tells, gathered from the results of any command."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from stribeck.report.comparison import worst_places
from stribeck.report.diagnosis import (
    ALIKE,
    diagnosis_summary,
    doubts,
    errors_sentence,
    explainable_after,
    explainable_text,
    floor_sentence,
    group_rows,
    likely_effects,
    trend_text,
    visible_heading,
    visible_rows,
)
from stribeck.report.fit import hardly_explained
from stribeck.report.improvement import passivity_sentence, stopped_sentence, summary_sentence
from stribeck.report.numbers import change_text, percent, plain
from stribeck.report.unexplained import left_after, left_text

if TYPE_CHECKING:
    from stribeck.diagnosis.compare import Comparison
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis
    from stribeck.diagnosis.testable import Untestable
    from stribeck.fitting.result import Fit
    from stribeck.passivity.certificate import Certificate
    from stribeck.projects.project import Project


#: Errors that differ by a smaller share are called alike: no effect is added for less.
SAME = 0.01
#: Samples of more models than this would hide each other.
MOST_SHOWN = 3


@dataclass(frozen=True)
class Step:
    """An effect that was found, added or dropped, with the evidence for it.

    Attributes
    ----------
    verb : {"found", "add", "drop"}
        ``"found"``: tried alone and not added.
    before, after : Fit
        The models before and after the step.
    confidence, share : float, optional
        0..1; None where no diagnosis was asked.
    """

    verb: str
    effect: str
    before: Fit
    after: Fit
    confidence: float | None
    share: float | None
    where: str
    ties: tuple[str, ...]

    @property
    def label(self) -> str:
        """``+ load`` or ``- load``."""
        return f"{'-' if self.verb == 'drop' else '+'} {self.effect}"


@dataclass(frozen=True)
class Account:
    """What is known of a recording and its models.

    Attributes
    ----------
    summary : str
        What was found, in one sentence.
    models : tuple of Fit
        The models that the figures show.
    final : Fit
        The model whose parameters and passivity are told.
    comparison : Comparison, optional
        Errors of models over the same samples, all and by regime.
    steps : tuple of Step
        In their order; or what a diagnosis found, best first.
    likely : int
        Number of `steps` before those that are less likely.
    diagnosis : Diagnosis, optional
        What the last model lacks, or the model that was asked about.
    left : tuple of str
        Sentences on what is still unexplained.
    untestable : tuple of Untestable
        What the recording cannot show.
    noise_floor : float, optional
        In the unit of torque.
    certificate : Certificate, optional
        Of the last model's passivity.
    passivity : str
        Whether the last model is passive, in one sentence; empty: as its fit says.
    command : str
        The command that made it; empty in Python.
    """

    summary: str
    models: tuple[Fit, ...]
    final: Fit
    comparison: Comparison | None = None
    steps: tuple[Step, ...] = ()
    likely: int = 0
    diagnosis: Diagnosis | None = None
    left: tuple[str, ...] = ()
    untestable: tuple[Untestable, ...] = ()
    noise_floor: float | None = None
    certificate: Certificate | None = None
    passivity: str = ""
    command: str = ""

    def made_by(self, command: str, certificate: Certificate | None) -> Account:
        """With the command that made it and the proof of passivity of the last model."""
        return replace(self, command=command, certificate=certificate)

    def lists(self) -> list[tuple[str, list[str]]]:
        """Headings with a sentence for each effect that was tried and not found, or not claimed."""
        if self.diagnosis is None:
            return []
        found = [
            *doubts(self.diagnosis),
            (visible_heading(self.diagnosis), visible_rows(self.diagnosis.smallest_visible)),
            (ALIKE, group_rows(self.diagnosis.groups)),
        ]
        return [(heading, rows) for heading, rows in found if rows]


def of_comparison(comparison: Comparison, untestable: Iterable[Untestable] = ()) -> Account:
    """Of models side by side; the last of the page is the one with the smallest error."""
    ranked = sorted(comparison.models, key=lambda a: -error_of(a.fit))
    best = ranked[-1]
    unit = best.fit.model.torque_unit
    places = worst_places(best, 1)
    place, _, said = places[0].partition(": ") if places else ("", "", "")
    worst = f" Its largest errors ({place}): {said}." if places else ""
    held = "held-out error" if best.rmse_held_out is not None else "error"
    if len(ranked) == 1:
        summary = f"The {held} of {best.model} is {plain(error_of(best.fit))} {unit}.{worst}"
    elif error_of(ranked[0].fit) * (1.0 - SAME) < error_of(best.fit):
        summary = (
            f"The {held}s of the {len(ranked)} models differ by less than {100.0 * SAME:.0f} %; "
            f"the smallest is {plain(error_of(best.fit))} {unit}, of {best.model}.{worst}"
        )
    else:
        summary = (
            f"Of {len(ranked)} models, {best.model} has the smallest {held}, "
            f"{plain(error_of(best.fit))} {unit}.{worst}"
        )
    return Account(
        summary,
        tuple(a.fit for a in ranked[-MOST_SHOWN:]),
        best.fit,
        comparison,
        untestable=tuple(untestable),
        noise_floor=comparison.noise_floor,
    )


def of_diagnosis(diagnosis: Diagnosis, comparison: Comparison | None = None) -> Account:
    """Of what is missing from one model; the first finding is drawn beside it."""
    fitted = diagnosis.fit
    steps = tuple(
        Step(
            "found",
            f.effect,
            f.before,
            f.fit,
            f.confidence,
            f.share_of_unexplained,
            f.where,
            f.indistinguishable_from,
        )
        for f in diagnosis.findings
    )
    left = (
        errors_sentence(diagnosis),
        left_after(diagnosis),
        explainable_after(diagnosis),
        trend_text(diagnosis.trend),
    )
    return Account(
        diagnosis_summary(diagnosis),
        (fitted, *(f.fit for f in diagnosis.findings[:1])),
        fitted,
        comparison,
        steps,
        len(likely_effects(diagnosis)),
        diagnosis,
        tuple(sentence for sentence in left if sentence),
        diagnosis.untestable,
        diagnosis.noise_floor.value,
    )


def of_improvement(improvement: Improvement, comparison: Comparison | None = None) -> Account:
    """Of the steps from a base model to one whose residual is noise."""
    base, final = improvement.base, improvement.final
    steps = tuple(
        Step(
            "add",
            s.finding.effect,
            s.before,
            s.after,
            s.finding.confidence,
            s.finding.share_of_unexplained,
            s.finding.where,
            s.finding.indistinguishable_from,
        )
        for s in improvement.steps
    )
    unit = final.model.torque_unit
    left = (
        stopped_sentence(improvement),
        floor_sentence(improvement.noise_floor, unit),
        left_text(improvement.unexplained, improvement.final.recording),
        explainable_text(improvement.last.explainable, final.model.spec, unit),
        trend_text(improvement.last.trend),
        _relative_sentence(final),
    )
    return Account(
        summary_sentence(improvement),
        (base, final) if steps else (base,),
        final,
        comparison,
        steps,
        len(steps),
        improvement.last,
        tuple(sentence for sentence in left if sentence),
        improvement.untestable,
        improvement.noise_floor.value,
        passivity=passivity_sentence(improvement),
    )


def of_project(project: Project, diagnosis: Diagnosis, comparison: Comparison | None) -> Account:
    """Of the branch of a project that ends at its current node.

    Parameters
    ----------
    diagnosis : Diagnosis
        Of the current node.
    """
    path = project.tree.path(project.current)
    fits = [project.fit_of(node) for node in path]
    steps = tuple(
        Step(
            node.change,
            node.found.effect,
            before,
            after,
            node.found.confidence,
            node.found.share,
            node.found.where,
            node.found.ties,
        )
        for node, before, after in zip(path[1:], fits, fits[1:], strict=False)
        if node.found is not None
    )
    here = of_diagnosis(diagnosis, comparison)
    if not steps:
        return here
    unit = fits[-1].model.torque_unit
    first, last = error_of(fits[0]), error_of(fits[-1])
    summary = (
        f"From {fits[0].model.spec} to {fits[-1].model.spec} the error falls from {plain(first)} "
        f"to {plain(last)} {unit} ({change_text(first, last)}). {here.summary}"
    )
    return replace(
        here,
        summary=summary,
        models=(fits[0], fits[-1]),
        final=fits[-1],
        steps=steps,
        likely=len(steps),
    )


def _relative_sentence(fit: Fit) -> str:
    """The relative residual of a fit, where there is one."""
    if fit.relative_residual is None:
        return ""
    what = "norm of the held-out error / norm of the torque"
    said = f"Relative residual ({what}): {percent(fit.relative_residual)}. {hardly_explained(fit)}"
    return said.strip()


def error_of(fit: Fit) -> float:
    """The held-out error of a fit, or its error where there is none."""
    return fit.rmse if fit.rmse_held_out is None else fit.rmse_held_out
