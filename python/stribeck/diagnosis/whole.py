"""Long recordings: causes are looked for on stretches, the models identified on all rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.floor import NoiseFloor
from stribeck.diagnosis.ranking import share_of_unexplained
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search import QUICK, THOROUGH, Effort
from stribeck.recording.recording import Recording

__all__ = ["NEAR", "noted", "on_all_rows", "recounted", "with_all_rows"]

#: For a fit that is reported, from values that others of the same rows have led to: of a million
#: rows values settle to about a thousandth of their standard error.
NEAR = replace(THOROUGH, evaluations=0, finished=1, tolerance=1e-12)


def on_all_rows(
    found: Fit, recording: Recording, transient: NDArray[np.bool_], effort: Effort = QUICK
) -> Fit:
    """A model that was fitted to stretches of `recording` identified on all of it."""
    return fit(found.model, recording, starts=1, transient=transient, effort=effort)


def recounted(finding: Finding, before: Fit, after: Fit, floor: NoiseFloor) -> Finding:
    """A finding with the errors of all rows."""
    return replace(
        finding,
        rmse_held_out_before=float(before.rmse_held_out or np.nan),
        rmse_held_out_after=float(after.rmse_held_out or np.nan),
        share_of_unexplained=share_of_unexplained(before, after, floor),
        fit=after,
        before=before,
    )


def noted(fitted: Fit, rows: int) -> Fit:
    """`fitted` with a note on how many rows causes were looked for."""
    note = f"causes were looked for on {rows} of {fitted.recording.rows} rows, in stretches"
    return replace(fitted, notes=(*fitted.notes, note))


def with_all_rows(found: Diagnosis, whole: Fit) -> Diagnosis:
    """A diagnosis of stretches with the errors of all rows, those of `whole`."""
    findings = []
    for finding in found.findings:
        after = on_all_rows(finding.fit, whole.recording, whole.transient)
        findings.append(recounted(finding, whole, after, found.noise_floor))
    rows = found.fit.recording.rows
    return replace(found, fit=noted(whole, rows), findings=tuple(findings))
