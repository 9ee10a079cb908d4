"""Effects that imitate one which predicts better, and cannot itself be claimed.

Where causes in the measurement explain an effect as well as friction does, it is not claimed. What
it explains is then left for the next effect, which predicts worse and is no cause either. The same
holds where the better effect acts within a time or a distance that the recording does not resolve:
something acts there. One that acts beyond what the recording reaches bends to fit anything.
"""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.unresolved import unresolved
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import TIE, Trial, adds_to, tie_statistic
from stribeck.effect.describe import is_friction
from stribeck.fitting.result import Fit
from stribeck.models.catalog import simpler_effect


def without_outshone(imitated: Sifted, sift: Sifted, tried: int, least: float, seed: int) -> Sifted:
    """`sift` without friction effects that add nothing to an imitated one that predicts better.

    Parameters
    ----------
    imitated
        Before the causes in the measurement were considered.
    sift
        After it: what stood before and is in doubt now is what these causes explain.
    """
    stood = {trial.effect for trial in imitated.stand}
    stand = {trial.effect for trial in sift.stand}
    # Of an effect whose simpler part stands, only what it adds to that is in doubt.
    doubted = [
        row.trial
        for row in (*sift.demoted, *sift.refused)
        if row.trial.effect in stood and simpler_effect(row.trial.effect) not in stand
    ]
    friction = [trial for trial in sift.stand if is_friction(trial.effect)]
    return _demoted(sift, friction, doubted, tried, least, seed)


def without_unresolved(before: Fit, sift: Sifted, tried: int, least: float, seed: int) -> Sifted:
    """`sift` without effects that add nothing to one that the recording does not resolve."""
    better = [
        row.trial
        for row in sift.refused
        if unresolved(Claim(row.trial.effect, before, row.trial.fit, least)) is not None
    ]
    return _demoted(sift, sift.stand, better, tried, least, seed)


def _demoted(
    sift: Sifted,
    trials: Sequence[Trial],
    doubted: Sequence[Trial],
    tried: int,
    least: float,
    seed: int,
) -> Sifted:
    """`sift` with those of `trials` demoted that one of `doubted` outshines."""
    for trial in trials:
        for better in doubted:
            if tie_statistic(better, trial) <= TIE or adds_to(better, trial, tried, least, seed):
                continue
            reason = f"{better.effect} predicts better, and leaves nothing to it"
            sift = sift.instead(trial, Sifted(demoted=(Doubted(trial, reason),)))
            break
    return sift
