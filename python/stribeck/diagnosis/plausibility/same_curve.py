"""Rule: an effect is no second form of one that the model has.

A Stribeck curve below which no Coulomb friction is left is a curve of the speed of any kind: one of
viscous friction too. Beside nonlinear viscous friction it bends that curve, and is no further
effect.
"""

from __future__ import annotations

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.registry import find, of_catalog


def same_curve(claim: Claim) -> str | None:
    """Which effect of the model it cannot be told from; None where there is none."""
    known = find(claim.effect)
    if known is None or known.free_form is None:
        return None
    alike = known.alike(claim.before, claim.after)
    for other in claim.before.model.effects:
        if other in alike and of_catalog(other).free_form is known.free_form:
            return f"the motion cannot tell it from {other}, which the model has"
    return None
