"""Rules: an effect acts over a time, distance or speed that the recording resolves and reaches."""

from __future__ import annotations

from collections.abc import Iterator

from stribeck.diagnosis.plausibility.claim import Claim, first_reason
from stribeck.effect.base import Effect
from stribeck.effect.registry import find


def unresolved(claim: Claim) -> str | None:
    """Why the effect acts within what the recording resolves; None where it does not."""
    return first_reason(known.unresolved(claim.after) for known in _claimed(claim))


def out_of_reach(claim: Claim) -> str | None:
    """Why the effect acts beyond what the recording reaches; None where it does not."""
    return first_reason(known.out_of_reach(claim.after) for known in _claimed(claim))


def _claimed(claim: Claim) -> Iterator[Effect]:
    """The effect, and the simpler one that came with it, such as the curve of a frictional lag."""
    earlier = claim.before.model.effects
    came = [e for e in claim.after.model.effects if e not in earlier and e != claim.effect]
    for effect in (claim.effect, *came):
        known = find(effect)
        if known is not None:
            yield known
