"""Rule: what other joints do is no effect of this one.

Where other joints of the file move and the load torque is not known, their links load this joint
with a torque that no model of it has. It depends on the position where the joints move together,
and looks like any effect of the position, the load or the acceleration.
"""

from __future__ import annotations

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.models.catalog import effect_row

#: Effects that read one of these channels may be what other joints do: all but those of an
#: actuator, whose waves are short.
CHANNELS = {"position", "load_torque", "acceleration"}


def other_joints(claim: Claim) -> str | None:
    """That other joints move, for an effect that they may imitate; None otherwise."""
    row = effect_row(claim.effect)
    if row is None or row["group"] == "actuator" or not CHANNELS & set(row["channels"]):
        return None
    recording = claim.after.recording
    if recording.load_torque is not None or all(c.check != "others" for c in recording.checks):
        return None
    return "other joints move as well, and what they carry loads this joint, which may look alike"
