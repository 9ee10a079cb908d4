"""What a fit to a data set prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.numbers import plain, thousands
from stribeck.report.text import PASSIVITY, notes_text, paragraph, parameters_text

if TYPE_CHECKING:
    from stribeck.streaming.result import StreamedFit


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
