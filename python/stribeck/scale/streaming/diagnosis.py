"""A diagnosis of a data set: made on the samples in memory, with errors over all samples."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.base.shown import Shown
from stribeck.diagnosis.result import Diagnosis
from stribeck.scale.streaming.improvement import before_and_after
from stribeck.scale.streaming.result import StreamedFit

__all__ = ["StreamedDiagnosis"]


@dataclass(frozen=True, repr=False)
class StreamedDiagnosis(Shown):
    """The effects missing from a model on a data set.

    Attributes
    ----------
    found
        The diagnosis of the samples in memory.
    fit, with_finding
        The model without findings, and with each of them, identified on all samples.
    """

    found: Diagnosis
    fit: StreamedFit
    with_finding: tuple[StreamedFit, ...]

    def to_dict(self) -> dict[str, object]:
        """The contract's JSON of `stribeck diagnose`; errors are over all samples."""
        made = self.found.to_dict()
        floor = self.found.noise_floor
        made["findings"] = [
            {**finding.to_dict(), **before_and_after(self.fit, after, floor)}
            for finding, after in zip(self.found.findings, self.with_finding, strict=True)
        ] + [row.to_dict() for row in self.found.demoted]
        own = self.fit.to_dict()
        made.update({key: own[key] for key in ("rmse", "rmse_held_out", "scored", "data", "notes")})
        return made
