"""Rule: no cause has a larger torque than all that was measured."""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number

#: Share of the samples in which the torque of the effect must not exceed the span.
QUANTILE = 0.99


def too_large(claim: Claim) -> str | None:
    """Why the effect's torque is too large; None where it is not.

    The torque exceeds the span of the measured torque minus the known load, and of zero, in 1 % of
    the samples. Zero counts: a constant load can be larger than all changes of the torque, as on a
    vertical axis.
    """
    if claim.torque is None:
        return None
    recording = claim.before.recording
    measured = (recording.torque - recording.known_torque)[claim.rows]
    span = float(max(measured.max(), 0.0) - min(measured.min(), 0.0))
    own = float(np.quantile(np.abs(claim.torque), QUANTILE))
    if own <= span:
        return None
    unit = claim.after.model.torque_unit
    of = " minus the known load" if recording.torque_holds_load else ""
    return (
        f"its torque would be {number(own)} {unit}, and the range of the measured torque{of}, zero "
        f"included, is only {number(span)} {unit}"
    )
