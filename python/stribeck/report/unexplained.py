"""What remains unexplained, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stribeck.report.numbers import percent

if TYPE_CHECKING:
    from stribeck.diagnosis.residual.unexplained import Unexplained
    from stribeck.diagnosis.result import Diagnosis
    from stribeck.recording.recording import Recording


def left_after(diagnosis: Diagnosis) -> str:
    """How much of the error is more than noise once the first finding is added, if asked."""
    if not diagnosis.unexplained.asked:
        return ""
    left = left_text(diagnosis.unexplained, diagnosis.fit.recording)
    if not diagnosis.findings:
        return left
    return f"With {diagnosis.findings[0].effect} added, {left[0].lower()}{left[1:]}"


def left_text(left: Unexplained, recording: Recording) -> str:
    """How much of the error is more than noise, and how much of it was not judged.

    Where other joints of the file move, that they may be the cause.
    """
    said = _structure(left)
    others = next((check.said for check in recording.checks if check.check == "others"), None)
    if left.is_structure and others is not None:
        said += f" {others[0].upper()}{others[1:]}."
    if left.is_partial:
        said += (
            f" Not judged are the samples that the fit excludes (see the notes): they cause "
            f"{percent(left.excluded)} of the squared held-out error of all samples."
        )
    return said


def _structure(left: Unexplained) -> str:
    if left.share is None:
        return "It cannot be estimated from this data how much of the remaining error is noise."
    if left.share == 0.0:
        # The held-out error may still exceed the noise floor, as where a recording is short.
        return "No significant structure remains."
    if not left.is_structure:
        return (
            f"No significant structure remains: {percent(left.share)} of the squared held-out "
            f"error is shown to be more than noise."
        )
    where = f"; {left.where}" if left.where and left.where != "everywhere" else ""
    return (
        f"Unexplained structure remains: {percent(left.share)} of the squared held-out error is "
        f"more than noise{where}."
    )
