"""Trials that pass the test of evidence, judged by the rules of `plausibility`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import NotClaimed, impossible, weak
from stribeck.diagnosis.trials.trial import Trial
from stribeck.fitting.result import Fit


@dataclass(frozen=True)
class Demoted:
    """A trial whose evidence is too narrow, and why."""

    trial: Trial
    reason: str


@dataclass(frozen=True)
class Sifted:
    """Trials by what the rules say of them.

    Attributes
    ----------
    stand
        Those that may be claimed, in the order in which they came.
    demoted
        Those that too few events carry.
    not_claimed
        Effects whose values cannot be right.
    """

    stand: tuple[Trial, ...] = ()
    demoted: tuple[Demoted, ...] = ()
    not_claimed: tuple[NotClaimed, ...] = ()

    @classmethod
    def of(cls, before: Fit, trials: Sequence[Trial], least: float) -> Sifted:
        """Judge each of `trials`; `least` is the fall that a finding must bring."""
        stand: list[Trial] = []
        demoted: list[Demoted] = []
        refused: list[NotClaimed] = []
        for trial in trials:
            claim = Claim(trial.effect, before, trial.fit, least)
            if (reason := impossible(claim)) is not None:
                refused.append(NotClaimed(trial.effect, reason))
            elif (reason := weak(claim)) is not None:
                demoted.append(Demoted(trial, reason))
            else:
                stand.append(trial)
        return cls(tuple(stand), tuple(demoted), tuple(refused))

    def with_stand(self, trials: Sequence[Trial]) -> Sifted:
        """The same with other trials that stand."""
        return Sifted(tuple(trials), self.demoted, self.not_claimed)

    def instead(self, trial: Trial, judged: Sifted) -> Sifted:
        """The same without one trial that stands, and with what was `judged` of it again."""
        return Sifted(
            tuple(t for t in self.stand if t.effect != trial.effect),
            (*self.demoted, *judged.demoted),
            (*self.not_claimed, *judged.not_claimed),
        )
