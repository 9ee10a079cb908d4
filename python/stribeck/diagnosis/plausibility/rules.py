"""The table of rules, and what they say of a claim.

An effect whose values are impossible only imitates another cause: it is not claimed. One that too
few events or samples carry, or only with the most extreme shape, or that has another size in
another condition, or leaves much where it acts, may be right, but this recording cannot show it: it
is demoted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from stribeck.diagnosis.plausibility.cancelling import cancelling
from stribeck.diagnosis.plausibility.claim import Claim, first_reason
from stribeck.diagnosis.plausibility.few_events import few_events, one_event
from stribeck.diagnosis.plausibility.leaves_more import leaves_more
from stribeck.diagnosis.plausibility.negative import (
    negative_friction,
    negative_inertia,
    negative_under_load,
)
from stribeck.diagnosis.plausibility.noise_of_load import noise_of_load
from stribeck.diagnosis.plausibility.other_joints import other_joints
from stribeck.diagnosis.plausibility.other_part import other_part_changes
from stribeck.diagnosis.plausibility.same_curve import same_curve
from stribeck.diagnosis.plausibility.shape import few_samples, shape_at_bound
from stribeck.diagnosis.plausibility.steady import steady
from stribeck.diagnosis.plausibility.too_large import too_large
from stribeck.diagnosis.plausibility.uneven import uneven
from stribeck.diagnosis.plausibility.unresolved import out_of_reach, unresolved
from stribeck.diagnosis.plausibility.worsened import worsened

#: A rule: the reason why a claim breaks it, or None.
Rule = Callable[[Claim], str | None]

#: An effect that breaks one of these is not claimed.
IMPOSSIBLE: tuple[Rule, ...] = (
    too_large,
    cancelling,
    negative_friction,
    negative_inertia,
    negative_under_load,
    unresolved,
    out_of_reach,
    other_part_changes,
    steady,
    noise_of_load,
    same_curve,
    worsened,
)
#: Nor is one with which another effect of the model breaks one of these.
OF_OTHERS: tuple[Rule, ...] = (too_large, unresolved, out_of_reach)
#: One that breaks one of these is demoted.
WEAK: tuple[Rule, ...] = (
    few_events,
    one_event,
    few_samples,
    shape_at_bound,
    uneven,
    leaves_more,
    other_joints,
)

#: The highest confidence of a demoted finding: as likely as not.
DEMOTED = 0.5


@dataclass(frozen=True)
class NotClaimed:
    """An effect that lowers the held-out error and cannot be right, or is imitated, and why."""

    effect: str
    reason: str

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"effect": self.effect, "reason": self.reason}


def impossible(claim: Claim) -> str | None:
    """Why the values of a claim cannot be right; None where they can.

    Nor may it make those of another effect impossible.
    """
    if (reason := _first(IMPOSSIBLE, claim)) is not None:
        return reason
    for other in claim.before.model.effects:
        reason = _first(OF_OTHERS, replace(claim, effect=other))
        earlier = replace(claim, effect=other, after=claim.before)
        if reason is not None and _first(OF_OTHERS, earlier) is None:
            return f"it makes {other} impossible: {reason}"
    return None


def weak(claim: Claim) -> str | None:
    """Why a recording cannot show what is claimed; None where it can."""
    return _first(WEAK, claim)


def _first(rules: tuple[Rule, ...], claim: Claim) -> str | None:
    return first_reason(rule(claim) for rule in rules)
