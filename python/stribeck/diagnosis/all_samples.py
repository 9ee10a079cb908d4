"""Long recordings: effects are searched on stretches, models identified on all samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.residual.explainable import explainable
from stribeck.diagnosis.residual.noise_floor import NoiseFloor, noise_floor
from stribeck.diagnosis.residual.unexplained import unexplained
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search.effort import QUICK, Effort
from stribeck.recording.recording import Recording


def on_all_samples(
    found: Fit, recording: Recording, transient: NDArray[np.bool_], effort: Effort = QUICK
) -> Fit:
    """Identify a model that was fitted to stretches of `recording` on all of it."""
    return fit(found.model, recording, starts=1, transient=transient, effort=effort)


def with_errors_of(finding: Finding, before: Fit, after: Fit, floor: NoiseFloor) -> Finding:
    """A finding with the errors of two fits to all samples."""
    return replace(
        finding,
        rmse_held_out_before=float(before.rmse_held_out or np.nan),
        rmse_held_out_after=float(after.rmse_held_out or np.nan),
        share_of_unexplained=share_of_unexplained(before, after, floor),
        fit=after,
        before=before,
    )


def with_excerpt_note(fitted: Fit, rows: int) -> Fit:
    """`fitted` with a note on how many samples effects were searched."""
    note = f"effects were searched on {rows} of {fitted.recording.rows} samples, in stretches"
    return replace(fitted, notes=(*fitted.notes, note))


def with_remainder_on_all_samples(found: Diagnosis, whole: Fit) -> Diagnosis:
    """A diagnosis of stretches with what remains on all samples: those of `whole`, its model."""
    floor = noise_floor(whole)
    if not found.unexplained.asked:
        return replace(found, noise_floor=floor)
    explained = None if floor.value is None else explainable(whole)
    return replace(
        found,
        noise_floor=floor,
        explainable=explained,
        unexplained=unexplained(whole, floor, explained, last=not found.findings),
    )


def with_errors_on_all_samples(found: Diagnosis, whole: Fit) -> Diagnosis:
    """A diagnosis of stretches with the errors on all samples, those of `whole`."""
    claims = (*found.findings, *found.demoted)
    fits = [on_all_samples(claim.fit, whole.recording, whole.transient) for claim in claims]
    floor = noise_floor(fits[0] if found.findings else whole)
    made = [with_errors_of(c, whole, after, floor) for c, after in zip(claims, fits, strict=True)]
    count = len(found.findings)
    return replace(
        found,
        fit=with_excerpt_note(whole, found.fit.recording.rows),
        noise_floor=floor,
        findings=tuple(made[:count]),
        demoted=tuple(made[count:]),
    )
