"""An effect that is added on trial: two causes that are missing hide each other.

Without the other, neither predicts much better than causes in the measurement; or one gains in one
block alone, since elsewhere the other is large; or neither gains more than chance may, or anything
at all. One of them is added on trial, the search goes on, and the effect stays if it stands beside
the others. Where others have taken its place, they stay if each of them stands.
"""

from __future__ import annotations

from dataclasses import replace

from stribeck.diagnosis.loop.superfluous import fit_without
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible, weak
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.imitations import NARROW, standing
from stribeck.diagnosis.trials.proxies import without_proxies
from stribeck.diagnosis.trials.trial import Trial, passes
from stribeck.effect.describe import is_friction
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_ids


def trials_of(found: Diagnosis) -> list[Finding]:
    """The findings to add on trial, until one stands: one in doubt, and one of a pair."""
    doubtful = on_trial(found)
    of_a_pair = None if found.pair is None else found.pair.first
    return [finding for finding in (doubtful, of_a_pair) if finding is not None]


def on_trial(found: Diagnosis) -> Finding | None:
    """The finding to add on trial: the best of those that another missing cause may hide.

    Causes in the measurement explain them as well, or they gain in one block alone; or they gain no
    more than chance may, since the other adds as much as noise. None where there is none.
    """
    doubtful: list[Finding] = []
    if found.unexplained.is_structure:
        doubtful = [
            finding
            for finding in found.demoted
            if is_friction(finding.effect)
            and weak(Claim(finding.effect, finding.before, finding.fit)) is None
        ]
        doubtful += found.in_one_block
    likely = doubtful or found.uncertain
    best = min(likely, key=lambda finding: finding.rmse_held_out_after, default=None)
    return None if best is None else replace(best, demoted=None)


def judged(finding: Finding, current: Fit, least: float, seed: int) -> Finding | None:
    """The finding as the other effects of the model `current` leave it, None where it falls.

    Its confidence is at most that of an effect which predicts hardly better than causes in the
    measurement, since alone it does not.
    """
    without = fit_without(current, finding, seed)
    if without is None:
        return None
    trial = Trial(finding.effect, current, evidence(without, current))
    claim = Claim(finding.effect, without, current)
    if not passes(trial, len(effect_ids()), least) or impossible(claim) or weak(claim):
        return None
    if not without_proxies(without, [trial]) or not standing(without, trial, (), least).stand:
        return None
    return replace(finding, weight=NARROW)
