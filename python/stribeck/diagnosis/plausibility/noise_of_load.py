"""Rule: a drive train does not act where the load torque is only noise.

What lowers the error mostly there removes noise from the load torque.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number
from stribeck.effect.describe import is_drive_train
from stribeck.models.load_noise import load_noise
from stribeck.models.rigid_body import load_torque

#: Standard deviations of the noise within which a load torque may be noise alone.
WITHIN = 3.0
#: Share of its gain from which an effect removes noise.
MOST = 0.5
#: Fewest samples there.
FEWEST = 300


def noise_of_load(claim: Claim) -> str | None:
    """Why the effect removes noise from the load torque; None where it does not."""
    recording, rows = claim.before.recording, claim.rows
    load = load_torque(claim.after.model, recording) if is_drive_train(claim.effect) else None
    noise = 0.0 if load is None else load_noise(recording, load)
    if load is None or not noise > 0.0:
        return None
    idle = np.abs(load[rows]) <= WITHIN * noise
    without, along = (
        claim.before.weighted(fit.held_out_residual[rows]) ** 2
        for fit in (claim.before, claim.after)
    )
    gain = without - along
    total, there = float(np.sum(gain)), float(np.sum(gain[idle]))
    if idle.sum() < FEWEST or there < MOST * total:
        return None
    share = 100.0 * min(there / total, 1.0)
    return (
        f"{number(share, 2)} % of what it gains is where the load torque is within its own noise, "
        f"so it removes that noise"
    )
