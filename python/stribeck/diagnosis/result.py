"""The result of a diagnosis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import polars as pl

from stribeck.base.shown import Plotted
from stribeck.diagnosis.plausibility.carried import Carried
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import NotClaimed
from stribeck.diagnosis.residual.explainable import Explainable
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.trend import Trend, trend
from stribeck.diagnosis.visibility.result import Group, SmallestVisible
from stribeck.fitting.result import Fit


@dataclass(frozen=True, repr=False)
class Finding(Plotted):
    """An effect that passed the test.

    Attributes
    ----------
    weight
        Probability that it is this effect, and neither noise nor one of those it is
        indistinguishable from, 0..1.
    certainty
        Probability that the model predicts new samples better with it, 0..1, by the differences of
        the held-out errors.
    part
        What it explains of the squared error that it and the structure left unexplained make up
        together, 0..1; known at the end of `improve`. Limited where more structure remains than it
        explains.
    where
        One sentence: where the data shows it.
    fit, before
        The models with and without it.
    demoted
        Why the recording cannot show it, where it is demoted.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=20.0, rate=50.0, seed=1)[0])
    >>> best = sb.diagnose(sb.fit("coulomb", recording, starts=1), recording).findings[0]
    >>> best.effect, best.confidence > 0.9, best.fit.model.spec
    ('load', True, 'coulomb+load')
    >>> best.rmse_held_out_after < 0.2 * best.rmse_held_out_before
    True
    """

    effect: str
    weight: float
    certainty: float
    rmse_held_out_before: float
    rmse_held_out_after: float
    share_of_unexplained: float | None
    where: str
    indistinguishable_from: tuple[str, ...]
    fit: Fit
    before: Fit
    demoted: str | None = None
    part: float = 1.0

    @property
    def confidence(self) -> float:
        """The smallest of weight, certainty and part, 0..1."""
        return min(self.weight, self.certainty, self.part)

    @cached_property
    def carried(self) -> Carried:
        """Which samples and moves carry what it gains."""
        return Carried.of(Claim(self.effect, self.before, self.fit))

    def to_dict(self) -> dict[str, object]:
        """The JSON of one finding."""
        return {
            "effect": self.effect,
            "confidence": self.confidence,
            "rmse_held_out_before": self.rmse_held_out_before,
            "rmse_held_out_after": self.rmse_held_out_after,
            "share_of_unexplained": self.share_of_unexplained,
            "where": self.where,
            "indistinguishable_from": list(self.indistinguishable_from),
            **self.support(),
        }

    def support(self) -> dict[str, object]:
        """What carries the finding, as JSON."""
        return {
            "share_of_rows": self.carried.share,
            "carried_by": self.carried.to_dict(),
            "demoted": self.demoted,
        }


@dataclass(frozen=True)
class Pair:
    """Two effects that predict only together.

    Attributes
    ----------
    first
        The one that predicts better alone, added alone.
    second
        The other, as the model names it.
    fall
        Relative fall of the held-out RMSE by both, linearised.
    """

    first: Finding
    second: str
    fall: float


@dataclass(frozen=True)
class Tried:
    """The effects that were tried, ids or formulas, and what one had to show to be a finding.

    Attributes
    ----------
    screened
        Number of effects over which a finding must be significant.
    least_fall
        The least relative fall of the held-out RMSE.
    """

    effects: tuple[str, ...] = ()
    screened: int = 1
    least_fall: float = 0.0


@dataclass(frozen=True, repr=False)
class Diagnosis(Plotted):
    """What is missing from a model on a recording.

    Attributes
    ----------
    verdict : {"missing", "none", "unexplained"}
        ``"unexplained"`` also where effects pass the test but are demoted or not claimed.
    findings
        Effects that pass the test, best first.
    demoted
        Effects that pass it, but that the recording does not show well enough to be claimed, or
        that causes in the measurement explain as well.
    not_claimed
        Effects that pass it with values that cannot be right, or that causes in the measurement
        explain better.
    passed
        All effects that pass the test of evidence alone, ids or formulas, the best first.
    tried
        All effects that were tried.
    in_one_block
        Effects that would pass, but gain in one block alone; not asked where `brief` finds some.
    uncertain
        Effects that predict better, but not by more than chance may: what else is missing may hide
        them; not asked where `brief` finds some.
    explained
        Effects that pass, but add nothing where those of the model may take any smooth form, whose
        own form is not that of what is missing, or whose size is at its bound.
    pair
        Two effects that predict only together; asked where structure remains and nothing is found.
    smallest_visible
        For each effect that was tried and not found, the smallest that would have been found.
    groups
        Effects that are indistinguishable on this recording.
    explainable
        The share of the explainable torque that the model explains.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=20.0, rate=50.0, seed=1)[0])
    >>> found = sb.diagnose(sb.fit("coulomb", recording, starts=1), recording)
    >>> found.verdict, found.findings[0].effect
    ('missing', 'load')
    """

    fit: Fit
    noise_floor: NoiseFloor
    verdict: str
    findings: tuple[Finding, ...]
    untestable: tuple[Untestable, ...]
    unexplained: Unexplained
    smallest_visible: tuple[SmallestVisible, ...] = ()
    groups: tuple[Group, ...] = ()
    explainable: Explainable | None = None
    demoted: tuple[Finding, ...] = ()
    not_claimed: tuple[NotClaimed, ...] = ()
    passed: tuple[str, ...] = ()
    tried: Tried = Tried()
    in_one_block: tuple[Finding, ...] = ()
    uncertain: tuple[Finding, ...] = ()
    explained: tuple[NotClaimed, ...] = ()
    pair: Pair | None = None

    @property
    def unclaimed(self) -> tuple[NotClaimed, ...]:
        """All effects that lower the error and are not claimed, and why."""
        return (*self.not_claimed, *self.explained)

    @property
    def has_doubts(self) -> bool:
        """Whether effects lower the held-out error that are demoted or not claimed."""
        return bool(self.demoted or self.not_claimed)

    @cached_property
    def trend(self) -> Trend | None:
        """What changes along the recording, where no temperature was recorded to tell why.

        With the first finding added: an offset changes between runs as friction does.
        """
        return trend(self.findings[0].fit if self.findings else self.fit)

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck diagnose`."""
        made: dict[str, object] = {
            "model": self.fit.model.spec,
            "rmse": self.fit.rmse,
            "rmse_held_out": self.fit.rmse_held_out,
            "unit": self.fit.model.torque_unit,
            "noise_floor": self.noise_floor.value,
            "verdict": self.verdict,
            "findings": [row.to_dict() for row in (*self.findings, *self.demoted)],
            "not_claimed": [row.to_dict() for row in self.unclaimed],
            "untestable": [row.to_dict() for row in self.untestable],
            "unexplained": self.unexplained.to_dict(),
            "explainable": self.explainable.to_dict() if self.explainable else None,
            "trend": self.trend.to_dict() if self.trend else None,
            "smallest_visible": [row.to_dict() for row in self.smallest_visible],
            "indistinguishable_groups": [list(group.effects) for group in self.groups],
            "indistinguishable": [group.to_dict() for group in self.groups],
            "scored": self.fit.recording.scored(self.fit.scored),
            "notes": [*self.fit.recording.notes, *self.fit.notes],
        }
        if self.noise_floor.value is None:
            made["noise_floor_why"] = self.noise_floor.why
        return made

    def to_frame(self) -> pl.DataFrame:
        """The findings as a table."""
        return pl.DataFrame([finding.to_dict() for finding in self.findings])
