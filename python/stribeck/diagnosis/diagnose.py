"""Find the effects that are missing from a model."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from stribeck.base.arguments import door
from stribeck.base.checks import check_share
from stribeck.base.errors import FitError
from stribeck.base.pool import serial_linear_algebra
from stribeck.diagnosis.all_samples import (
    with_errors_on_all_samples,
    with_remainder_on_all_samples,
)
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import NotClaimed, impossible
from stribeck.diagnosis.plausibility.shape import shape_at_end
from stribeck.diagnosis.residual.explainable import explainable
from stribeck.diagnosis.residual.noise_floor import NoiseFloor, noise_floor
from stribeck.diagnosis.residual.unexplained import Unexplained, unexplained
from stribeck.diagnosis.result import Diagnosis, Finding, Pair, Tried
from stribeck.diagnosis.trials.candidates import Tested, candidates_for, tested
from stribeck.diagnosis.trials.imitations import NARROW, without_imitations
from stribeck.diagnosis.trials.outshone import without_outshone, without_unresolved
from stribeck.diagnosis.trials.pairs import best_pair
from stribeck.diagnosis.trials.proxies import without_proxies
from stribeck.diagnosis.trials.ranking import finding_of, ranked
from stribeck.diagnosis.trials.remainder import limited
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.sifting import Sifted
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, Trial, try_effect
from stribeck.diagnosis.visibility.visibility import visibility
from stribeck.fitting.fit import fit, on_recording, with_choices
from stribeck.fitting.result import FIT, Fit
from stribeck.identify.search.effort import FROM_NEARBY
from stribeck.identify.stated.choices import ChoiceArguments, parameters_of_effects
from stribeck.models.catalog import effect_ids
from stribeck.models.formula_law import effect_name
from stribeck.recording.motion.excerpt import SAMPLE_ROWS, excerpt
from stribeck.recording.several.concat import Recordings

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: Why an effect is not claimed whose own form is not that of what is missing.
FORM = (
    "the torque depends on the same quantity in another form: a free function of it explains more"
)
#: Why an effect is not claimed that the model explains in another form.
SHAPE = "a slightly different form of the effects that the model has would explain the same"
NOT_ASKED = Unexplained(None, None, asked=False)


@door(FitError, fitted=FIT)
@serial_linear_algebra
def diagnose(
    fitted: Fit,
    recording: Recordings | None = None,
    *,
    least_fall: float = LEAST_FALL,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    seed: int = 0,
    sample_rows: int = SAMPLE_ROWS,
    brief: bool = False,
    progress: Callable[[str], None] = lambda sentence: None,
    known: Callable[[Diagnosis], None] = lambda found: None,
    **choices: Unpack[ChoiceArguments],
) -> Diagnosis:
    """Find the effects that are missing from `fitted`.

    Every effect that the recording can show is added and refitted. It passes if the held-out RMSE
    falls by at least `least_fall` (or by half of it, and in the band of the motion by five times
    as much), if that is significant given the autocorrelation of the residual and the number of
    effects tried, and if the model cannot explain the same with effects of a more flexible shape.

    Parameters
    ----------
    recording : Recording
        Default: the recording of the fit. On another one the model is fitted again first.
    rejected : collection of str
        Effects that are not tried.
    candidates : collection of str
        Effects by formula that are tried as well: ``"creep = c*abs(load)*sgn(v)"``.
    sample_rows : int
        A longer recording is searched for effects on this number of samples, in evenly spaced
        stretches; the errors are those of all samples.
    brief : bool
        Without the smallest visible effects; where there are findings, without what remains as
        well, which may limit their confidence.
    progress, known : callable
        Called with a sentence after each candidate, and with what `brief` would return as soon as
        there are findings.
    **choices
        `start`, `bounds` and `fix` of `stribeck.fit`, of parameters of the model, which is then
        fitted again, or of the effects that are tried.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> found = sb.diagnose(sb.fit("coulomb", recording, starts=2), brief=True)
    >>> found.verdict, found.findings[0].effect
    ('missing', 'load')
    """
    check_share("least_fall", least_fall)
    own = parameters_of_effects(candidates=candidates)
    fitted = with_choices(on_recording(fitted, recording, seed), choices, own, seed)
    few = excerpt(fitted.recording, sample_rows, seed)
    is_whole = few is fitted.recording
    start = fitted if is_whole else fit(fitted.model, few, starts=1, effort=FROM_NEARBY)
    made, evidence = _findings(start, least_fall, rejected, candidates, seed, progress)
    shown = made if is_whole else with_errors_on_all_samples(made, fitted)
    if shown.findings:
        if brief:
            return shown
        known(shown)
    rest = _with_remainder(made, evidence)
    said = _as_shown(rest if brief else with_visibility(rest), shown)
    if is_whole:
        return said
    return with_remainder_on_all_samples(said, said.findings[0].fit if said.findings else fitted)


def _as_shown(whole: Diagnosis, shown: Diagnosis) -> Diagnosis:
    """A diagnosis with the errors of what was `shown` before, and the parts that it explains."""
    parts = {finding.effect: finding.part for finding in whole.findings}
    findings = tuple(replace(finding, part=parts[finding.effect]) for finding in shown.findings)
    return replace(whole, fit=shown.fit, findings=findings, demoted=shown.demoted)


def _findings(
    fitted: Fit,
    least_fall: float,
    rejected: Collection[str],
    candidates: Collection[str],
    seed: int,
    progress: Callable[[str], None],
) -> tuple[Diagnosis, Tested]:
    """A diagnosis with its findings alone, and the evidence that it is drawn from."""
    offered = candidates_for(fitted, rejected, candidates)
    found = tested(fitted, offered.possible, least_fall, seed, progress)
    passed, tried = found.passing, found.screened
    sift = Sifted.of(fitted, passed, least_fall, found.outside_the_band)
    possible = sift.stand
    stood = sift = sift.with_stand(without_proxies(fitted, list(possible)))
    left = {trial.effect for trial in sift.stand}
    proxies = [trial for trial in possible if trial.effect not in left]
    sift = without_imitations(fitted, stood, passed, tried, least_fall)
    sift = without_outshone(stood, sift, tried, least_fall, seed)
    sift = without_unresolved(fitted, sift, tried, least_fall, seed)
    best = sift.stand[0].fit if sift.stand else fitted
    floor = noise_floor(best)
    order = ranked(fitted, sift, tried, least_fall, floor, seed)
    made = Diagnosis(
        fitted,
        floor,
        "missing",
        order.findings,
        offered.untestable,
        NOT_ASKED,
        demoted=order.demoted,
        not_claimed=order.not_claimed,
        passed=tuple(t.fit.model.written(t.effect) for t in passed),
        explained=(
            *(NotClaimed(t.effect, FORM) for t in proxies),
            *(NotClaimed(t.effect, SHAPE) for t in found.explained),
            *(NotClaimed(t.effect, t.bound_reason) for t in found.at_bound),
        ),
        tried=Tried(offered.possible, tried, least_fall),
    )
    return made, found


def _with_remainder(found: Diagnosis, evidence: Tested) -> Diagnosis:
    """A diagnosis with what its findings leave unexplained, and its verdict."""
    fitted, floor = found.fit, found.noise_floor
    # Without repeated states a regressor learns nothing that holds on other blocks.
    after = found.findings[0].fit if found.findings else fitted
    explained = None if floor.value is None else explainable(fitted, after)
    structure = unexplained(after, floor, explained, last=not found.findings)
    # An effect that passes the test of evidence explains more than noise, if only by imitation.
    remains = structure.is_structure or found.has_doubts
    verdict = "missing" if found.findings else ("unexplained" if remains else "none")

    def possible(trials: list[Trial]) -> tuple[Finding, ...]:
        return tuple(
            finding_of(fitted, trial, NARROW, (), floor)
            for trial in trials
            if impossible(Claim(trial.effect, fitted, trial.fit)) is None
        )

    return replace(
        found,
        verdict=verdict,
        findings=limited(found.findings, evidence.passing, structure),
        unexplained=structure,
        explainable=explained,
        in_one_block=possible(evidence.in_one_block),
        uncertain=possible(evidence.uncertain),
        pair=_pair(fitted, evidence, floor) if verdict == "unexplained" else None,
    )


def _pair(fitted: Fit, evidence: Tested, floor: NoiseFloor) -> Pair | None:
    """Two effects that predict only together; None where there are none.

    Those that pass the test alone, and may not be claimed, are no part of it: what they explain is
    another cause. One whose shape ends at a bound may lack another that changes what it depends on.
    """
    judged = {trial.effect: trial for trial in evidence.passing}
    ends = {e for e, trial in judged.items() if shape_at_end(e, trial.fit.estimates)}
    best = best_pair(
        fitted,
        {e: s for e, s in evidence.screenings.items() if effect_name(e) not in judged},
        {e: s for e, s in evidence.screenings.items() if effect_name(e) in ends},
    )
    first = None if best is None else try_effect(fitted, evidence.screenings[best.first])
    if best is None or first is None:
        return None
    # Alone the first may be impossible, since it stands in for both.
    second = screened(first.fit, best.second)
    both = None if second is None else try_effect(first.fit, second)
    if both is None or impossible(Claim(both.effect, first.fit, both.fit)):
        return None
    finding = finding_of(fitted, first, NARROW, (), floor)
    return Pair(finding, effect_name(best.second), best.fall)


def with_visibility(found: Diagnosis) -> Diagnosis:
    """A diagnosis with what its recording could have shown of the effects that were tried."""
    tried = found.tried
    shown = visibility(
        found.fit,
        [effect for effect in tried.effects if effect in effect_ids()],
        found=_named(found),
        tried=tried.screened,
        significance=SIGNIFICANCE,
        least_fall=tried.least_fall,
    )
    return replace(
        found,
        untestable=(*found.untestable, *shown.hidden),
        smallest_visible=shown.smallest,
        groups=shown.groups,
    )


def _named(found: Diagnosis) -> set[str]:
    """Effects that a result names."""
    claims = (*found.findings, *found.demoted)
    named = {e for finding in claims for e in (finding.effect, *finding.indistinguishable_from)}
    return named | {row.effect for row in found.unclaimed}
