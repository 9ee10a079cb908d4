"""A diagnosis of a data set: made on stretches in memory, its findings counted on all rows."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.base.shown import Shown
from stribeck.diagnosis.result import Diagnosis
from stribeck.scale.streaming.improvement import before_and_after
from stribeck.scale.streaming.result import StreamedFit

__all__ = ["StreamedDiagnosis"]


@dataclass(frozen=True, repr=False)
class StreamedDiagnosis(Shown):
    """What is missing from a model on a data set.

    Attributes
    ----------
    found
        The diagnosis of the stretches in memory.
    fit, with_finding
        The model without and with each of the findings, identified on all rows.
    """

    found: Diagnosis
    fit: StreamedFit
    with_finding: tuple[StreamedFit, ...]

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck diagnose`; errors are of all rows."""
        made = self.found.to_dict()
        floor = self.found.noise_floor
        made["findings"] = [
            {**finding.to_dict(), **before_and_after(self.fit, after, floor)}
            for finding, after in zip(self.found.findings, self.with_finding, strict=True)
        ]
        own = self.fit.to_dict()
        made.update({key: own[key] for key in ("rmse", "rmse_held_out", "scored", "data", "notes")})
        return made
