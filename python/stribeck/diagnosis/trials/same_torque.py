"""Effects with impossible values that have the torque of another effect."""

from __future__ import annotations

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible
from stribeck.diagnosis.trials.trial import Trial
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: Two effects whose torques differ by less than this share have the same torque.
SAME = 0.02


def only_imitates(trial: Trial, best: Trial, before: Fit) -> bool:
    """Whether a trial has the torque of the best one, and values that cannot be right."""
    rows = before.rows
    torque = best.fit.prediction[rows]
    apart = rms(trial.fit.prediction[rows] - torque)
    return (
        apart <= SAME * rms(torque - before.prediction[rows])
        and impossible(Claim(trial.effect, before, trial.fit)) is not None
    )
