"""Trials that pass the test of evidence, judged by the rules of `plausibility`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from stribeck.base.pool import on_each
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible, weak
from stribeck.diagnosis.trials.trial import Trial
from stribeck.fitting.result import Fit


@dataclass(frozen=True)
class Doubted:
    """A trial that may not be claimed, and why."""

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
        Those whose evidence is too narrow, or that causes in the measurement explain as well.
    refused
        Those whose values cannot be right, or that causes in the measurement explain better.
    most
        The highest confidence of those that stand, but predict hardly better than causes in the
        measurement.
    rivals
        Trials that do not pass, and may predict as well as one that stands all the same.
    """

    stand: tuple[Trial, ...] = ()
    demoted: tuple[Doubted, ...] = ()
    refused: tuple[Doubted, ...] = ()
    most: Mapping[str, float] = field(default_factory=dict)
    rivals: tuple[Trial, ...] = ()

    @classmethod
    def of(
        cls, before: Fit, trials: Sequence[Trial], least: float, rivals: Sequence[Trial] = ()
    ) -> Sifted:
        """Judge each of `trials`; `least` is the fall that a finding must bring."""
        several = on_each(lambda trial: cls._of_one(before, trial, least), trials)
        return cls(
            tuple(trial for one in several for trial in one.stand),
            tuple(row for one in several for row in one.demoted),
            tuple(row for one in several for row in one.refused),
            rivals=tuple(rivals),
        )

    @classmethod
    def _of_one(cls, before: Fit, trial: Trial, least: float) -> Sifted:
        """Judge one trial."""
        claim = Claim(trial.effect, before, trial.fit, least)
        if (reason := impossible(claim)) is not None:
            return cls(refused=(Doubted(trial, reason),))
        if (reason := weak(claim)) is not None:
            return cls(demoted=(Doubted(trial, reason),))
        return cls(stand=(trial,))

    def with_stand(self, trials: Sequence[Trial]) -> Sifted:
        """The same with other trials that stand."""
        return replace(self, stand=tuple(trials))

    def narrowed(self, trial: Trial, most: float) -> Sifted:
        """The same with one trial that stands, but by little: with a confidence of at most that."""
        lowest = min(most, self.most.get(trial.effect, 1.0))
        return replace(self, most={**self.most, trial.effect: lowest})

    def instead(self, trial: Trial, judged: Sifted) -> Sifted:
        """The same without one trial that stands, and with what was `judged` of it again."""
        return Sifted(
            tuple(t for t in self.stand if t.effect != trial.effect),
            (*self.demoted, *judged.demoted),
            (*self.refused, *judged.refused),
            self.most,
            self.rivals,
        )
