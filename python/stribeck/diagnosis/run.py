"""A diagnosis from its parts."""

from __future__ import annotations

from collections.abc import Collection

from stribeck.diagnosis.bound import explainable
from stribeck.diagnosis.candidates import candidates_for, tried_on
from stribeck.diagnosis.floor import noise_floor
from stribeck.diagnosis.ranking import findings
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.stand_in import without_stand_ins
from stribeck.diagnosis.trial import SIGNIFICANCE
from stribeck.diagnosis.unexplained import Unexplained, unexplained
from stribeck.diagnosis.visibility import visibility
from stribeck.diagnosis.whole import NEAR, with_all_rows
from stribeck.fitting.fit import fit, on_recording
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_ids
from stribeck.recording.excerpt import SAMPLE_ROWS, excerpt
from stribeck.recording.recording import Recording

#: Least relative fall of the held-out RMSE that a finding must bring.
LEAST_FALL = 0.01
NOT_ASKED = Unexplained(None, None)


def diagnose(
    fitted: Fit,
    recording: Recording | None = None,
    *,
    least_fall: float = LEAST_FALL,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    seed: int = 0,
    sample_rows: int = SAMPLE_ROWS,
    brief: bool = False,
) -> Diagnosis:
    """Find the effects that are missing from `fitted`.

    Every effect that the recording can show is added and refitted. It passes if the held-out
    error falls by at least `least_fall`, if that is more than chance given the residual's
    autocorrelation and the number of effects tried, and if the effects already in the model
    cannot do the same by taking a freer form.

    Parameters
    ----------
    recording : Recording
        Default: the fit's own. On another one the model is fitted again first.
    rejected : collection of str
        Effects that are not to be tried.
    candidates : collection of str
        Effects by formula that are to be tried too: ``"creep = c*abs(load)*sgn(v)"``.
    sample_rows : int
        In a longer recording causes are looked for on so many rows, in stretches taken evenly; the
        errors are those of all rows.
    brief : bool
        Where there are findings, those alone: not what else could have been seen, nor how much of
        what can be explained is.
    """
    fitted = on_recording(fitted, recording, seed)
    few = excerpt(fitted.recording, sample_rows, seed)
    if few is not fitted.recording:
        found = diagnose(
            fit(fitted.model, few, starts=1, effort=NEAR), least_fall=least_fall,
            rejected=rejected, candidates=candidates, seed=seed, sample_rows=few.rows, brief=brief,
        )  # fmt: skip
        return with_all_rows(found, fitted)
    could_be = candidates_for(fitted, rejected, candidates)
    passed, tried = tried_on(fitted, could_be.possible, least_fall, seed)
    good = without_stand_ins(fitted, passed)
    best = good[0].fit if good else fitted
    floor = noise_floor(best)
    ranked = findings(fitted, good, tried, least_fall, floor, seed)
    if brief and ranked:
        return Diagnosis(fitted, floor, "missing", ranked, could_be.untestable, NOT_ASKED)
    # Where nothing repeats, a regressor can learn nothing that lasts.
    after = ranked[0].fit if ranked else fitted
    could = None if floor.value is None else explainable(fitted, after)
    left = unexplained(after, floor, could, last=not ranked)
    verdict = "missing" if ranked else ("unexplained" if left.is_structure else "none")
    shown = visibility(
        fitted,
        [effect for effect in could_be.possible if effect in effect_ids()],
        found={e for finding in ranked for e in (finding.effect, *finding.indistinguishable_from)},
        tried=tried,
        significance=SIGNIFICANCE,
        least_fall=least_fall,
    )
    return Diagnosis(
        fitted, floor, verdict, ranked, (*could_be.untestable, *shown.hidden), left,
        shown.smallest, shown.groups, could,
    )  # fmt: skip
