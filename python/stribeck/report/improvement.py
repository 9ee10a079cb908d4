"""An improvement or a single added effect as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.diagnosis.loop.determined import undetermined
from stribeck.effect.describe import physically
from stribeck.report.diagnosis import (
    doubts_text,
    explainable_text,
    finding_text,
    floor_sentence,
    hedged,
    nothing_found,
    trend_text,
    untestable_text,
)
from stribeck.report.fit import PASSIVITY, errors_text
from stribeck.report.layout import bars, joined, notes_text, paragraph
from stribeck.report.numbers import change_text, hedge, listed, percent, plain
from stribeck.report.parameters import (
    not_identifiable_text,
    open_text,
    parameters_text,
    poorly_determined_text,
    temperature_text,
)
from stribeck.report.recording import file_name, held_out_meaning
from stribeck.report.unexplained import left_text

if TYPE_CHECKING:
    from stribeck.diagnosis.loop.add import Addition
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.residual.noise_floor import NoiseFloor
    from stribeck.diagnosis.result import Finding
    from stribeck.fitting.result import Fit

STOPPED = {
    "noise_floor": "The residual is noise.",
    "nothing_passes": "Stopped: no further effect lowers the held-out error significantly.",
    "interrupted": "Stopped by Ctrl-C after these steps; more effects may be missing.",
    "max_steps": "Stopped at the maximum number of steps; more effects may be missing.",
}

#: An RMSE of all samples within the first ratio of the noise floor has reached it; a held-out error
#: of at least the second ratio times the RMSE is larger than it.
AT_THE_FLOOR, LARGER = 1.05, 1.1


def improvement_text(improvement: Improvement) -> str:
    """The way from the base model to the final one."""
    final, floor = improvement.final, improvement.noise_floor
    r, unit = final.recording, final.model.torque_unit
    steps = [finding_text(step.finding, k) for k, step in enumerate(improvement.steps, 1)]
    stopped = f"{stopped_sentence(improvement)} {left_text(improvement.unexplained, r)}"
    is_structure = improvement.unexplained.is_structure
    return joined(
        f"Improving {improvement.base.model.spec} on {file_name(r)}",
        paragraph(summary_sentence(improvement), 0),
        paragraph(f"Held-out error after each step ({held_out_meaning(final)}):", 0),
        improvement_bars(improvement),
        paragraph(floor_sentence(floor, unit), 0) if floor.value is None else "",
        joined("Found, in this order:", *steps) if steps else "",
        paragraph(stopped, 0),
        paragraph("" if is_structure else _above_the_floor(final, floor), 0),
        paragraph(explainable_text(improvement.last.explainable, final.model.spec, unit), 0),
        paragraph(trend_text(improvement.last.trend), 0),
        f"Final model: {final.model.spec}",
        parameters_text(final.estimates),
        temperature_text(final.model),
        open_text(final.estimates),
        not_identifiable_text(final.estimates, ()),
        poorly_determined_text(undetermined(final.estimates), improvement.combinations),
        errors_text(final),
        paragraph(passivity_sentence(improvement)),
        doubts_text(improvement.last),
        untestable_text(improvement.untestable),
        notes_text(r.notes, final.notes),
    )


def stopped_sentence(improvement: Improvement) -> str:
    """Why the loop ended."""
    if improvement.stopped == "nothing_passes" and improvement.last.has_doubts:
        return "Stopped: no further effect that lowers the held-out error can be claimed."
    if improvement.stopped == "noise_floor" and improvement.unexplained.is_partial:
        return "The residual of the samples that the fit uses is noise."
    return STOPPED[improvement.stopped]


def passivity_sentence(improvement: Improvement) -> str:
    """Whether the final model is passive, and what that would cost."""
    said, made = PASSIVITY[improvement.final.passive()], improvement.made_passive
    if made is None:
        return said
    if made.rmse is None:
        return f"{said} Made passive, it cannot be fitted: {made.why}."
    name, before, after = "RMSE", improvement.final.rmse, made.rmse
    if made.rmse_held_out is not None and improvement.final.rmse_held_out is not None:
        name, before = "held-out error", improvement.final.rmse_held_out
        after = made.rmse_held_out
    unit = improvement.final.model.torque_unit
    return (
        f"{said} Made passive, its {name} is {plain(after)} instead of {plain(before)} {unit} "
        f"({change_text(before, after)})."
    )


def step_labels(improvement: Improvement) -> list[str]:
    """The base and each added effect."""
    return [improvement.base.model.spec, *(f"+ {s.finding.effect}" for s in improvement.steps)]


def step_errors(improvement: Improvement) -> list[float | None]:
    """Held-out error of the base and after each step."""
    return [improvement.base.rmse_held_out, *(s.after.rmse_held_out for s in improvement.steps)]


def improvement_bars(improvement: Improvement) -> str:
    """The held-out error after each step as a bar, with the noise floor shaded."""
    return bars(
        step_labels(improvement),
        step_errors(improvement),
        improvement.noise_floor.value,
        improvement.final.model.torque_unit,
    )


def summary_sentence(improvement: Improvement) -> str:
    """What was found, in one sentence."""
    base, final = improvement.base, improvement.final
    unit, spec = final.model.torque_unit, base.model.spec
    if not improvement.steps:
        structure = improvement.unexplained.is_structure
        return nothing_found(improvement.last, spec, unexplained=structure)
    text = f"The model {spec} {_lacks([step.finding for step in improvement.steps])}"
    if base.rmse_held_out is None or final.rmse_held_out is None:
        return text + "."
    it = "it" if len(improvement.steps) == 1 else "them"
    text += (
        f": with {it} the held-out error falls from {plain(base.rmse_held_out)} to "
        f"{plain(final.rmse_held_out)} {unit}"
    )
    floor = improvement.noise_floor.value
    if floor is None:
        return text + "."
    noise = f"noise floor {plain(floor)} {unit}"
    if final.rmse_held_out < LARGER * floor and not improvement.unexplained.is_structure:
        return f"{text}, and the remaining error is noise ({noise})."
    return f"{text} ({noise})."


def _lacks(findings: list[Finding]) -> str:
    """``lacks`` and the effects, the sure ones first, the others with a word of doubt."""
    ordered = sorted(findings, key=lambda f: ("", "probably", "perhaps").index(hedge(f.confidence)))
    first = hedge(ordered[0].confidence)
    said = [hedged(f, "" if hedge(f.confidence) == first else None) for f in ordered]
    return f"{first} lacks {listed(said)}".strip()


def _above_the_floor(fitted: Fit, floor: NoiseFloor) -> str:
    """Why an error without significant structure exceeds the noise floor."""
    if floor.value is None or fitted.rmse_held_out is None:
        return ""
    spec, unit = fitted.model.spec, fitted.model.torque_unit
    if fitted.rmse > AT_THE_FLOOR * floor.value or fitted.rmse_held_out < LARGER * fitted.rmse:
        return ""
    return (
        f"Fitted to all samples, {spec} has an error of {plain(fitted.rmse)} {unit}, the noise "
        f"floor. The held-out error is larger because a part of the recording shows what no other "
        f"part does. A longer recording would decide."
    )


def addition_text(addition: Addition) -> str:
    """An effect added: error before and after, and the new parameters."""
    before, after, effect = addition.before, addition.after, addition.effect
    unit = after.model.torque_unit
    kind, first, second = "error", before.rmse, after.rmse
    if before.rmse_held_out is not None and after.rmse_held_out is not None:
        kind = f"held-out error ({held_out_meaning(after)})"
        first, second = before.rmse_held_out, after.rmse_held_out
    change = f"{percent(abs(1 - second / first))}, from {plain(first)} to {plain(second)} {unit}"
    verdict = f"The {kind} falls by {change}."
    if plain(second) == plain(first):
        verdict = f"The {kind} stays at {plain(first)} {unit}: the effect does not improve it."
    elif second > first:
        verdict = f"The {kind} rises by {change}: the effect does not improve it."
    return joined(
        f"{effect} added to {before.model.spec} on {file_name(after.recording)}",
        paragraph(physically(effect, after.model)),
        bars([before.model.spec, f"+ {effect}"], [first, second], None, unit),
        paragraph(verdict),
        parameters_text(after.estimates),
        errors_text(after),
        notes_text(after.recording.notes, after.notes),
    )
