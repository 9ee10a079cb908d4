"""Rule: where an effect acts, it leaves no more than it leaves elsewhere.

A delay has a torque of one shape. What happens once after each reversal, such as a shock of
backlash or a late start, is lowered by that torque and not explained: where the effect acts most of
the error remains, and it is far larger than that of other samples. Friction that is missing beside
it may leave as much. Then that is found first.
"""

from __future__ import annotations

import numpy as np

from stribeck.base import linear
from stribeck.diagnosis.carrying import fewest
from stribeck.diagnosis.flexible_shape import columns_of
from stribeck.diagnosis.plausibility.claim import Array, Claim
from stribeck.effect.base import number
from stribeck.effect.describe import is_drive_train, is_friction
from stribeck.identify.stated.loss import robust_scale

#: Share of the squared error that an effect must explain where it acts, and how many times as large
#: as elsewhere the error may be that it leaves there.
EXPLAINED, LEFT = 0.75, 3.0


def leaves_more(claim: Claim) -> str | None:
    """How much remains where the effect acts; None where it explains most of that.

    Friction is none of these causes. What a drive train does in a shock is faster than the samples.
    """
    if is_friction(claim.effect) or is_drive_train(claim.effect):
        return None
    changed = claim.change**2
    acts = np.argsort(-changed, kind="stable")[: fewest(changed)]
    without, along = (
        claim.before.weighted(fit.held_out_residual[claim.rows])
        for fit in (claim.before, claim.after)
    )
    along = _beyond_its_form(claim, along)
    usual = robust_scale(along)
    square_without, square_along = (float(np.sum(x[acts] ** 2)) for x in (without, along))
    noise = acts.size * usual**2
    left = np.sqrt(square_along / noise) if noise > 0.0 else 0.0
    if left <= LEFT or square_without - square_along >= EXPLAINED * (square_without - noise):
        return None
    return (
        f"where it acts, the error remains {number(left, 2)} times as large as elsewhere: another "
        f"cause acts there"
    )


def _beyond_its_form(claim: Claim, residual: Array) -> Array:
    """What the effect leaves [m] if its torque may have another form than that of its formula."""
    columns = columns_of(claim.effect, claim.after)
    if not columns:
        return residual
    free = np.column_stack([claim.before.weighted(column) for column in columns])
    return np.asarray(residual - free @ linear.least_norm(free.T @ free, free.T @ residual))
