"""Rule: a model is no sum of large torques that cancel each other."""

from __future__ import annotations

from stribeck.base.memo import Memo
from stribeck.diagnosis.plausibility.claim import Array, Claim, term_torques
from stribeck.effect.base import number
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: Largest ratio of the terms' torques, summed, to the torque of the model.
FOLD = 5.0
#: Sum of the RMS torques of all terms of a fit.
_TORQUES: Memo[Fit, float] = Memo()


def cancelling(claim: Claim) -> str | None:
    """Why the terms of the model cancel each other; None where they do not.

    An effect is not blamed for terms that cancelled without it, such as gravity and inertia of a
    pendulum that swings freely.
    """
    if claim.torque is None:
        return None
    total = _modelled(claim.after)
    level = rms(total)
    if not level > 0.0:
        return None
    fold = (rms(claim.torque) + rms(total - claim.torque)) / level
    if fold <= FOLD:
        fold = _fold(claim.after)
        if fold <= FOLD or _fold(claim.before) > FOLD:
            return None
    return (
        f"it would be balanced by other terms of the model: the torques of all are "
        f"{number(fold)} times their sum"
    )


def _modelled(fit: Fit) -> Array:
    """The modelled torque without the known load, array [m]."""
    return (fit.prediction - fit.recording.known_torque)[fit.rows]


def _fold(fit: Fit) -> float:
    """Sum of the RMS torques of all terms, divided by the RMS of their sum."""
    level = rms(_modelled(fit))
    if not level > 0.0:
        return 0.0
    torques = _TORQUES.of(
        fit, None, lambda: sum(rms(torque) for torque in term_torques(fit).values())
    )
    return torques / level
