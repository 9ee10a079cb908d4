"""Rule: what changes with time is what the effect says, where no temperature was recorded."""

from __future__ import annotations

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.trend import DRY, trend
from stribeck.effect.describe import is_friction
from stribeck.models.catalog import effect_row


def other_part_changes(claim: Claim) -> str | None:
    """Which other part of the model changes with time instead; None where it is dry friction.

    A drift of dry friction imitates that of viscous friction or of the motor's torque. An amplifier
    that warms up changes every part, and no friction alone.
    """
    row = effect_row(claim.effect)
    if row is None or "time" not in row["channels"]:
        return None
    found = trend(claim.before)
    if found is None:
        return None
    changing = [name for name, change in found.changes.items() if change.clear]
    if not is_friction(claim.effect):
        if found.cause != "friction":
            return None
        return f"over the recording {' and '.join(changing)} changes, not the gain"
    if found.cause == "gain":
        return "the load and friction change by the same share over the recording: it is the gain"
    if found.changes[DRY].clear:
        return None
    return f"over the recording {' and '.join(changing)} changes, not dry friction"
