"""The result of a diagnosis."""

from __future__ import annotations

from dataclasses import dataclass

import polars as pl

from stribeck.base.shown import Plotted
from stribeck.diagnosis.residual.explainable import Explainable
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.visibility.result import Group, SmallestVisible
from stribeck.fitting.result import Fit


@dataclass(frozen=True, repr=False)
class Finding(Plotted):
    """An effect that passed the test.

    Attributes
    ----------
    where
        One sentence: where the data shows it.
    fit, before
        The models with and without it.
    """

    effect: str
    confidence: float
    rmse_held_out_before: float
    rmse_held_out_after: float
    share_of_unexplained: float | None
    where: str
    indistinguishable_from: tuple[str, ...]
    fit: Fit
    before: Fit

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
        }


@dataclass(frozen=True, repr=False)
class Diagnosis(Plotted):
    """What is missing from a model on a recording.

    Attributes
    ----------
    verdict : {"missing", "none", "unexplained"}
    findings
        Effects that pass the test, best first.
    smallest_visible
        For each effect that was tried and not found, the smallest that would have been found.
    groups
        Effects that are indistinguishable on this recording.
    explainable
        The share of the explainable torque that the model explains.
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

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck diagnose`."""
        made: dict[str, object] = {
            "model": self.fit.model.spec,
            "rmse": self.fit.rmse,
            "rmse_held_out": self.fit.rmse_held_out,
            "unit": self.fit.model.torque_unit,
            "noise_floor": self.noise_floor.value,
            "verdict": self.verdict,
            "findings": [finding.to_dict() for finding in self.findings],
            "untestable": [row.to_dict() for row in self.untestable],
            "unexplained": self.unexplained.to_dict(),
            "explainable": self.explainable.to_dict() if self.explainable else None,
            "smallest_visible": [row.to_dict() for row in self.smallest_visible],
            "indistinguishable_groups": [list(group.effects) for group in self.groups],
            "indistinguishable": [group.to_dict() for group in self.groups],
            "scored": self.fit.recording.scored(),
            "notes": [*self.fit.recording.notes, *self.fit.notes],
        }
        if self.noise_floor.value is None:
            made["noise_floor_why"] = self.noise_floor.why
        return made

    def to_frame(self) -> pl.DataFrame:
        """The findings as a table."""
        return pl.DataFrame([finding.to_dict() for finding in self.findings])
