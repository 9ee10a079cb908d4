"""Friction effects that imitate one which predicts better, and is itself in doubt.

Where causes in the measurement explain an effect as well as friction does, it is not claimed. What
it explains is then left for the next effect, which predicts worse and is no cause either.
"""

from __future__ import annotations

from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import TIE, adds_to, tie_statistic
from stribeck.effect.describe import is_friction
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
        row
        for row in (*sift.demoted, *sift.refused)
        if row.trial.effect in stood and simpler_effect(row.trial.effect) not in stand
    ]
    for trial in sift.stand:
        if not is_friction(trial.effect):
            continue
        for row in doubted:
            better = row.trial
            if tie_statistic(better, trial) <= TIE or adds_to(better, trial, tried, least, seed):
                continue
            reason = f"{better.effect} predicts better, and leaves nothing to it"
            sift = sift.instead(trial, Sifted(demoted=(Doubted(trial, reason),)))
            break
    return sift
