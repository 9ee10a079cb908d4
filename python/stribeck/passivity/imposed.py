"""A passive fit: conditions are added until the model is proved passive over the whole box.

Passivity is a condition at every operating point of the box. Only the points that matter are held,
by the exchange method of semi-infinite programming (Blankenship and Falk 1976): each round finds
the conditions that the current fit violates, first at points over the box, then by the proof, and
fits again with these conditions added.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import FitError, SpecError, option
from stribeck.identify.constrained.conditions import Together
from stribeck.identify.constrained.minimise import minimise_under
from stribeck.identify.constrained.objective import Objective
from stribeck.identify.constrained.region import Region
from stribeck.identify.problem import Problem
from stribeck.models.model import Model
from stribeck.passivity.check import BUDGET
from stribeck.passivity.conditions import Conditions, FrictionOf
from stribeck.passivity.operating_box import Box, operating_box

Array = NDArray[np.float64]

#: Reserves of the margins, as shares of their sizes: the first one at the start, the next one
#: whenever a proof fails although every condition holds, and after each `PATIENCE` rounds, since
#: conditions at single points approach a proof ever more slowly.
RESERVES = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1)
PATIENCE = 15
#: Most fits under conditions, one a round.
MOST_ROUNDS = 60


@dataclass(frozen=True)
class PassiveCost:
    """The error that a passive fit adds, and how many conditions it holds.

    Attributes
    ----------
    imposed
        Whether conditions were needed; if not, the unconstrained fit is passive.
    rmse_free, rmse_held_out_free
        RMSE and held-out RMSE of the unconstrained fit, in the unit of torque.
    conditions
        Number of operating points and cycles at which passivity is imposed.
    reserve
        Share of its size that each margin keeps, so that the proof succeeds.
    """

    imposed: bool
    rmse_free: float
    rmse_held_out_free: float | None
    conditions: int
    reserve: float

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "imposed": self.imposed,
            "rmse_free": self.rmse_free,
            "rmse_held_out_free": self.rmse_held_out_free,
            "conditions": self.conditions,
            "reserve": self.reserve,
        }


@dataclass(frozen=True)
class Passive:
    """Values proved passive, the problem that they solve, and the conditions that were held."""

    values: Array
    problem: Problem
    conditions: Conditions
    converged: bool
    evaluations: int


def impose(
    objective: Objective,
    values: Array,
    typical: Array,
    region: Region,
    box_of: Callable[[Array, Array | None], Box],
    renewed: Callable[[Problem, Array], Problem],
) -> Passive:
    """The best values near `values` with which friction is proved passive over the box.

    Parameters
    ----------
    values, typical : arrays [p]
        The best values without conditions of passivity; the typical start of a search, used where
        `values` lead to no passive model.
    region
        Bounds, ties and the conditions that hold besides passivity.
    box_of
        The operating box for values and their load torque.
    renewed
        The problem with the load torque for new values, where the rigid body is identified too.

    Raises
    ------
    FitError
        No values within the bounds were proved passive.
    """
    problem = objective.problem
    conditions = Conditions(FrictionOf.of(problem.model.with_values(values)))
    evaluations, converged = 0, True
    for number in range(MOST_ROUNDS):
        if number and number % PATIENCE == 0:
            conditions = replace(conditions, reserve=_larger(conditions.reserve) or RESERVES[-1])
        box = _box(conditions.part.friction, box_of(values, problem.load))
        more = _missed(conditions, values, box)
        if more is None:
            return Passive(values, problem, conditions, converged, evaluations)
        conditions = more
        within = replace(region, conditions=Together((region.conditions, conditions)))
        whole = replace(objective, problem=problem)
        searches = [minimise_under(whole, values, within)]
        if not np.isfinite(searches[0].square):
            searches.append(minimise_under(whole, typical, within))
        search = searches[-1]
        evaluations += sum(search.evaluations for search in searches)
        if not np.isfinite(search.square):
            raise FitError(_impossible(problem.model.spec, conditions, values))
        values, converged = search.values, search.converged
        problem = renewed(problem, values)
    raise FitError(
        f"{problem.model.spec} was not proved passive in {MOST_ROUNDS} rounds, with "
        f"{len(conditions.requirements)} conditions held: narrow the bounds "
        f"({option('bounds')}), or use another law"
    )


def _missed(conditions: Conditions, values: Array, box: Box) -> Conditions | None:
    """The conditions with those that these values violate; None: proved passive."""
    held = len(conditions.requirements)
    if held:
        more = conditions.with_missed(conditions.spread(values, box), values)
        if len(more.requirements) > held:
            return more
    friction = conditions.part.friction
    own = conditions.part.values(values)
    passive, condition, asked = _core.missed(friction.core, own, dict(box), BUDGET)
    if passive:
        return None
    if condition == "unknown" or asked is None:
        raise FitError(_undecidable(friction, condition))
    if held:
        more = conditions.with_missed([asked], values)
        if len(more.requirements) > held:
            return more
    # No condition is violated, and still there is no proof: keep larger margins.
    reserve = _larger(conditions.reserve)
    if reserve is None:
        raise FitError(_undecidable(friction, condition))
    more = replace(conditions, reserve=reserve)
    return more.with_missed([asked, *more.spread(values, box)], values)


def _larger(reserve: float) -> float | None:
    return next((larger for larger in RESERVES if larger > reserve), None)


def _box(friction: Model, box: Box) -> dict[str, tuple[float, float]]:
    known = {name: side for name, side in box.items() if name in friction.core.needs}
    try:
        return operating_box(replace(friction, box={}), known)
    except SpecError:
        missing = [name for name in friction.core.needs if name not in known]
        raise FitError(
            f"{friction.spec} cannot be proved passive: its friction depends on "
            f"{' and '.join(missing)}, whose range the recording does not show; fit it without "
            f"{option('passive')}"
        ) from None


def _undecidable(friction: Model, condition: str) -> str:
    why = (
        "no exact condition is known for states or branches of this kind"
        if condition == "unknown"
        else f"condition {condition!r} stays undecided with the largest margins"
    )
    return (
        f"{friction.spec} cannot be fitted as passive: {why}; fit it without {option('passive')}, "
        f"or use another law"
    )


def _impossible(spec: str, conditions: Conditions, values: Array) -> str:
    shares, _ = conditions.shares(values)
    worst = conditions.requirements[int(np.argmin(shares))]
    at = " and ".join(
        ", ".join(f"{name} {value:.4g}" for name, value in point.items()) for point in worst.points
    )
    kind = {
        "strength": "dry friction is not positive",
        "sliding": "friction does not oppose the motion",
        "cycle": "the bristle generates energy between two points",
    }[worst.kind]
    return (
        f"no passive {spec} was found within its bounds: with the best values "
        f"{kind} ({at}); widen the bounds ({option('bounds')}), leave an effect out, or use "
        f"another law"
    )
