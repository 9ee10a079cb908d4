"""Rule: the time or distance over which an effect acts lies within what the recording resolves."""

from __future__ import annotations

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.registry import find


def unresolved(claim: Claim) -> str | None:
    """Why the recording does not resolve the effect; None where it does.

    Nor the simpler effect that came with it, such as the Stribeck curve of a frictional lag.
    """
    earlier = claim.before.model.effects
    came = [e for e in claim.after.model.effects if e not in earlier and e != claim.effect]
    for effect in (claim.effect, *came):
        known = find(effect)
        reason = None if known is None else known.unresolved(claim.after)
        if reason is not None:
            return reason
    return None
