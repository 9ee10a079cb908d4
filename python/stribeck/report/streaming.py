"""Results on a data set that is larger than memory, as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.diagnosis import diagnosis_text
from stribeck.report.fit import PASSIVITY
from stribeck.report.improvement import improvement_text, step_labels
from stribeck.report.layout import bars, joined, notes_text, paragraph
from stribeck.report.numbers import plain, thousands
from stribeck.report.parameters import (
    correlation_text,
    not_identifiable_text,
    parameters_text,
)

if TYPE_CHECKING:
    from stribeck.scale.streaming.diagnosis import StreamedDiagnosis
    from stribeck.scale.streaming.improvement import StreamedImprovement
    from stribeck.scale.streaming.result import StreamedFit


def streamed_fit_text(fit: StreamedFit) -> str:
    """A fit at a glance."""
    unit, files = fit.model.torque_unit, len(fit.data.files)
    read = (
        f"{thousands(fit.rows)} samples in {files} file{'s' if files > 1 else ''}, read "
        f"{fit.passes} time{'s' if fit.passes > 1 else ''} in {plain(fit.pass_seconds)} s "
        f"({thousands(round(fit.rows_per_second))} samples per second). "
        f"The {thousands(fit.moving)} moving samples are scored."
    )
    errors = f"  error (RMSE)    {plain(fit.rmse)} {unit}"
    if fit.rmse_held_out is not None:
        errors += (
            f"\n  held-out error  {plain(fit.rmse_held_out)} {unit}  each of {fit.blocks} blocks "
            f"is predicted by a model fitted without it"
        )
    return joined(
        f"{fit.model.spec} fitted to {fit.data.path}",
        paragraph(read),
        parameters_text(fit.estimates),
        not_identifiable_text(fit.estimates, fit.combinations),
        correlation_text(fit.covariance.correlation()),
        errors,
        paragraph(PASSIVITY[fit.passive]),
        "" if fit.converged else paragraph(f"The search did not converge ({fit.outcome})."),
        notes_text(fit.start.recording.notes, fit.notes),
    )


def streamed_improvement_text(improvement: StreamedImprovement) -> str:
    """The improvement on the samples in memory, then its errors on all samples."""
    found, final = improvement.found, improvement.final
    errors = [fit.rmse_held_out for fit in improvement.fits]
    return joined(
        _searched(final),
        improvement_text(found),
        paragraph("Held-out error on all samples after each step:", 0),
        bars(step_labels(found), errors, found.noise_floor.value, final.model.torque_unit),
        streamed_fit_text(final),
    )


def streamed_diagnosis_text(diagnosis: StreamedDiagnosis) -> str:
    """The diagnosis of the samples in memory, then the errors on all samples."""
    found, fit = diagnosis.found, diagnosis.fit
    labels = [found.fit.model.spec, *(f"+ {finding.effect}" for finding in found.findings)]
    errors = [fit.rmse_held_out, *(after.rmse_held_out for after in diagnosis.with_finding)]
    return joined(
        _searched(fit),
        diagnosis_text(found),
        paragraph("Held-out error on all samples without and with each finding:", 0),
        bars(labels, errors, found.noise_floor.value, fit.model.torque_unit),
    )


def _searched(fit: StreamedFit) -> str:
    """How much of the data the search for effects used."""
    sample = fit.start.recording
    return paragraph(
        f"Effects were searched for in {thousands(sample.rows)} samples: contiguous parts, spread "
        f"over all {thousands(fit.rows)}. Errors and parameters for all samples are at the end.",
        0,
    )
