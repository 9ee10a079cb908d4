"""The results of a diagnosis that a project stores."""

from __future__ import annotations

from dataclasses import dataclass, field

from stribeck.diagnosis.result import Diagnosis, Finding


@dataclass(frozen=True)
class Found:
    """An effect that passed the test.

    Attributes
    ----------
    confidence
        0..1, from a diagnosis; None if the user added the effect without one.
    rmse_held_out
        Held-out error with the effect, in the unit of torque.
    share
        Share of the squared error above the noise floor, 0..1; None if there is no noise floor.
    where
        One sentence: where in the data the effect is visible.
    ties
        Effects indistinguishable from it with this data.
    """

    effect: str
    confidence: float | None
    rmse_held_out: float | None
    share: float | None
    where: str
    ties: tuple[str, ...] = ()

    @classmethod
    def of(cls, finding: Finding) -> Found:
        """Return the stored part of a finding."""
        return cls(
            finding.effect,
            finding.confidence,
            finding.fit.rmse_held_out,
            finding.share_of_unexplained,
            finding.where,
            finding.indistinguishable_from,
        )

    def to_dict(self) -> dict[str, object]:
        """As JSON, with the keys of a diagnosis."""
        return {
            "effect": self.effect,
            "confidence": self.confidence,
            "rmse_held_out_after": self.rmse_held_out,
            "share_of_unexplained": self.share,
            "where": self.where,
            "indistinguishable_from": list(self.ties),
        }


@dataclass(frozen=True)
class Remembered:
    """Summary of a diagnosis.

    Attributes
    ----------
    verdict : {"missing", "none", "unexplained"}
    noise_floor
        In the unit of torque; None where it cannot be estimated.
    left, left_where
        Share of the squared error that is unexplained structure with the best finding added, and
        where it occurs.
    full
        The full diagnosis, if it was made in this session.
    """

    verdict: str
    noise_floor: float | None
    left: float | None
    left_where: str | None
    findings: tuple[Found, ...]
    full: Diagnosis | None = field(default=None, compare=False, repr=False)

    @classmethod
    def of(cls, diagnosis: Diagnosis) -> Remembered:
        """Return the summary of a diagnosis."""
        return cls(
            diagnosis.verdict,
            diagnosis.noise_floor.value,
            diagnosis.unexplained.share,
            diagnosis.unexplained.where,
            tuple(Found.of(finding) for finding in diagnosis.findings),
            diagnosis,
        )

    def finding(self, effect: str) -> Found | None:
        """Return the finding of an effect, if there is one."""
        return next((found for found in self.findings if found.effect == effect), None)

    def to_dict(self) -> dict[str, object]:
        """For JSON."""
        return {
            "verdict": self.verdict,
            "noise_floor": self.noise_floor,
            "unexplained": {"share": self.left, "where": self.left_where},
            "findings": [found.to_dict() for found in self.findings],
        }
