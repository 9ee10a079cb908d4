"""What a fit to a data set prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report import text as in_memory
from stribeck.report.numbers import plain, thousands
from stribeck.report.text import PASSIVITY, bars, notes_text, paragraph, parameters_text

if TYPE_CHECKING:
    from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
    from stribeck.scale.streaming.improvement import StreamedImprovement
    from stribeck.scale.streaming.result import StreamedFit


def fit_text(fit: StreamedFit) -> str:
    """A fit at a glance."""
    unit = fit.model.torque_unit
    files = len(fit.data.files)
    read = (
        f"{thousands(fit.rows)} rows in {files} file{'s' if files > 1 else ''}, read "
        f"{fit.passes} time{'s' if fit.passes > 1 else ''} in {plain(fit.pass_seconds)} s "
        f"({thousands(round(fit.rows_per_second))} rows a second); {thousands(fit.moving)} of them "
        f"move and count."
    )
    errors = [f"  error (RMSE)    {plain(fit.rmse)} {unit}"]
    if fit.rmse_held_out is not None:
        errors.append(
            f"  held-out error  {plain(fit.rmse_held_out)} {unit}, each of {fit.blocks} blocks of "
            f"the data set predicted without it"
        )
    parts = [
        f"{fit.model.spec} fitted to {fit.data.path}",
        paragraph(read),
        parameters_text(fit.estimates),
        "\n".join(errors),
        paragraph(PASSIVITY[fit.passive]),
        "" if fit.converged else paragraph(f"The search did not converge ({fit.outcome})."),
        notes_text(fit.start.recording.notes, fit.notes),
    ]
    return "\n\n".join(part for part in parts if part)


def improvement_text(improvement: StreamedImprovement) -> str:
    """The way on the stretches in memory, then its errors on all rows."""
    found, final = improvement.found, improvement.final
    labels = [found.base.model.spec, *(f"+ {step.finding.effect}" for step in found.steps)]
    errors = [fit.rmse_held_out for fit in improvement.fits]
    return "\n\n".join(
        [
            looked_at(final),
            in_memory.improvement_text(found),
            paragraph("On all rows, the held-out error after each step:", 0),
            bars(labels, errors, found.noise_floor.value, final.model.torque_unit),
            fit_text(final),
        ]
    )


def diagnosis_text(diagnosis: StreamedDiagnosis) -> str:
    """The diagnosis of the stretches in memory, then the errors on all rows."""
    found, fit = diagnosis.found, diagnosis.fit
    labels = [found.fit.model.spec, *(f"+ {finding.effect}" for finding in found.findings)]
    errors = [fit.rmse_held_out, *(after.rmse_held_out for after in diagnosis.with_finding)]
    return "\n\n".join(
        [
            looked_at(fit),
            in_memory.diagnosis_text(found),
            paragraph("On all rows, the held-out error without and with each finding:", 0),
            bars(labels, errors, found.noise_floor.value, fit.model.torque_unit),
        ]
    )


def looked_at(fit: StreamedFit) -> str:
    """How much of the data the search for causes has seen."""
    sample = fit.start.recording
    return paragraph(
        f"Causes were looked for on {thousands(sample.rows)} rows, contiguous stretches spread "
        f"over all {thousands(fit.rows)}; errors and parameters on all rows follow at the end.", 0
    )  # fmt: skip
