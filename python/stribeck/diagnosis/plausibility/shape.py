"""Rules: a recording resolves the shape of an effect, and the shape is not at its limit."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stribeck.base.errors import StribeckError
from stribeck.diagnosis.plausibility.carried import Carried, move_of
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number
from stribeck.effect.describe import acts_in_shocks
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.scaling import bounds
from stribeck.identify.search.effort import QUICK
from stribeck.models.catalog import effect_row

#: Samples in each move, for each parameter of an effect, that must carry it, unless they are so
#: large a share of the move.
FEWEST, LARGE = 3, 0.01
#: Samples of a recording that must carry an effect, unless they are so large a share of it.
FEWEST_IN_ALL, SHARE_IN_ALL = 30, 0.1
#: Share of its gain that an effect must keep with the usual value of a shape parameter that ends at
#: a bound.
KEPT = 0.5
#: Starts of a fit with a shape parameter at its usual value: another shape has another minimum.
STARTS = 3


def few_samples(claim: Claim) -> str | None:
    """Why too few samples, or too few of each move, carry the effect; None where enough do.

    Few samples show that the torque jumps there, and not how it changes. A shock is such a jump.
    """
    if claim.before.recording.averaged or acts_in_shocks(claim.effect):
        return None
    carried = Carried.of(claim)
    if carried.events == 0:
        return None
    move = move_of(claim)
    carry = carried.share * move.size
    if carry < min(FEWEST_IN_ALL, SHARE_IN_ALL * move.size):
        return (
            f"only {number(carry)} of {move.size} samples carry 90 % of what it gains: too few to "
            f"tell it from another cause that acts there"
        )
    each = carry / carried.events
    length = move.size / max(np.unique(move).size, 1)
    parameters = len(claim.after.model.names) - len(claim.before.model.names)
    # An effect of one parameter, such as a delay, claims no shape.
    if parameters < 2:
        return None
    if each >= min(FEWEST * parameters, LARGE * length):
        return None
    return (
        f"only {number(each, 2)} samples a move carry 90 % of what it gains, of "
        f"{number(length, 2)}: too few to show how the torque changes there"
    )


def shape_at_bound(claim: Claim) -> str | None:
    """Which shape parameter of the effect must be at its bound; None where none must.

    The size of an effect is another matter: there the effect is not claimed at all.
    """
    for name, usual in usual_shape(claim.effect, claim.after).items():
        if _kept(claim, name, usual) < KEPT:
            return (
                f"{name} is at its bound {number(claim.after.model.value(name))}, and with its "
                f"usual value {number(usual)} most of what the effect gains is lost"
            )
    return None


def shape_at_end(effect: str, estimates: Mapping[str, Estimate]) -> list[str]:
    """The shape parameters of an effect that end at a bound other than 0."""
    row = effect_row(effect)
    names = [] if row is None else [p["name"] for p in row["parameters"][1:]]
    ends = [estimates[name] for name in names if name in estimates]
    return [end.name for end in ends if end.at_bound and end.value != 0.0]


def usual_shape(effect: str, after: Fit) -> dict[str, float]:
    """The shape parameters of an effect that end at a bound, with their usual values.

    One at 0 switches a part of the effect off.
    """
    ends = shape_at_end(effect, after.estimates)
    if not ends:
        return {}
    usual = dict(zip(after.model.names, bounds(after.model, after.recording)[2], strict=True))
    return {name: float(usual[name]) for name in ends}


def _kept(claim: Claim, name: str, value: float) -> float:
    """Share of the gain that is left where a parameter is held at a value."""
    before, after = claim.before, claim.after
    try:
        plain = fit(
            after.model,
            after.recording,
            starts=STARTS,
            transient=after.transient,
            effort=QUICK,
            fix={name: value},
        )
    except StribeckError:
        return 0.0
    return share_kept(before, after, plain)


def share_kept(before: Fit, after: Fit, plain: Fit) -> float:
    """Share of the gain of `after` over `before` that `plain` brings too, by held-out errors."""
    squares = [
        float(np.sum(before.weighted(fitted.held_out_residual[before.rows]) ** 2))
        for fitted in (before, after, plain)
    ]
    gain = squares[0] - squares[1]
    return (squares[0] - squares[2]) / gain if gain > 0.0 else 1.0
