"""Fits with priors, constraints, ties or a robust loss, from the best values without them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import FitError, option
from stribeck.fitting.solve import Solution
from stribeck.identify.constrained.conditions import Together
from stribeck.identify.constrained.constraints import ParameterConstraints, Ties
from stribeck.identify.constrained.minimise import Conditioned, minimise_under
from stribeck.identify.constrained.objective import Objective
from stribeck.identify.constrained.optimality import Optimality, polished
from stribeck.identify.constrained.region import Region
from stribeck.identify.errors.covariance import correlation_length
from stribeck.identify.errors.estimates import Errors, Identified
from stribeck.identify.errors.face import estimates_on_face
from stribeck.identify.errors.uncertainty import Uncertainty, identified
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.separable import Search
from stribeck.identify.search.space import SearchSpace
from stribeck.identify.stated.loss import Loss, LossName, robust_scale
from stribeck.identify.stated.prior import Prior
from stribeck.models.model import Model
from stribeck.models.rigid_body import needs_own_load, own_load

__all__ = ["PLAIN", "HeldConstraint", "Under", "prior_conflicts", "solve_under"]

Array = NDArray[np.float64]

#: A search ends at a smaller relative decrease; most steps of a search, and most
#: evaluations of the last one.
SETTLED, MOST_STEPS, MOST_POLISHING = 1e-12, 100, 300
#: Rounds of the level of the noise, the scale of a loss and the load of an identified rigid body,
#: and the relative change that ends them.
MOST_ROUNDS, STAYS = 50, 1e-9
#: Further starts between the bounds, where a search is thorough.
MORE_STARTS = 3
#: A prior is far from the data beyond so many standard errors of both together.
CONFLICT = 3.0
#: A point is a minimum if the conditions of Karush, Kuhn and Tucker hold to this share.
OPTIMAL = 1e-8


#: The JSON of a fit without statements.
PLAIN: Mapping[str, object] = {
    "constraints": [],
    "ties": {},
    "priors": {},
    "noise_of_priors": None,
    "loss": "squares",
    "loss_scale": None,
    "kkt_residual": None,
}


@dataclass(frozen=True)
class HeldConstraint:
    """A constraint at the solution: its slack, in its own unit, and whether it is active."""

    text: str
    slack: float
    active: bool

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"constraint": self.text, "slack": self.slack, "active": self.active}


@dataclass(frozen=True)
class Under:
    """What the values of a fit were found under, and how well they are a minimum.

    Attributes
    ----------
    objective, region
        What was minimised, and where.
    optimality
        At the solution.
    formulas, constraints
        The constraints, and each with its slack.
    loss_weight : array [n] or None
        Weights of a robust loss at the solution; 1 for samples that were not fitted to.
    """

    objective: Objective
    region: Region
    optimality: Optimality
    formulas: ParameterConstraints
    constraints: tuple[HeldConstraint, ...]
    loss_weight: Array | None

    def at(
        self, values: Array, objective: Objective, region: Region, optimality: Optimality
    ) -> Under:
        """The same statements at other values [p]."""
        rows = zip(
            self.formulas.formulas,
            self.formulas.slacks(values).tolist(),
            optimality.active[: self.formulas.count].tolist(),
            strict=True,
        )
        held = tuple(HeldConstraint(one.text, slack, active) for one, slack, active in rows)
        weight = _loss_weight(objective, values)
        return Under(objective, region, optimality, self.formulas, held, weight)

    def notes(self) -> tuple[str, ...]:
        """What a reader has to know of the standard errors and of the search."""
        active = [held.text for held in self.constraints if held.active]
        made: list[str] = []
        if active:
            made.append(
                f"active at the solution: {', '.join(active)}; standard errors are those along "
                f"{'it' if len(active) == 1 else 'them'}"
            )
        if self.optimality.residual > OPTIMAL:
            made.append(
                f"the conditions for a minimum hold to {self.optimality.residual:.1g} only, not to "
                f"{OPTIMAL:.0g}"
            )
        return tuple(made)

    @property
    def refit(self) -> Conditioned:
        """How held-out refits are done."""
        return Conditioned(self.objective, self.region)

    @property
    def priors(self) -> Mapping[str, tuple[float, float]]:
        """Mean and standard deviation of each prior, by parameter."""
        prior, names = self.objective.prior, self.objective.problem.model.names
        if prior is None:
            return {}
        rows = zip(
            prior.places.tolist(), prior.mean.tolist(), prior.deviation.tolist(), strict=True
        )
        return {names[place]: (mean, deviation) for place, mean, deviation in rows}

    @property
    def ties(self) -> Mapping[str, str]:
        """The formula of each tied parameter."""
        ties, names = self.region.ties, self.objective.problem.model.names
        pairs = zip(ties.places.tolist(), ties.formulas, strict=True)
        return {names[place]: formula.text for place, formula in pairs}

    def identified(self, values: Array, errors: Errors) -> Identified:
        """The parameters with their standard errors."""
        return estimates_on_face(self.objective, values, self.region, self.optimality, errors)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        loss, prior = self.objective.loss, self.objective.prior
        return {
            "constraints": [held.to_dict() for held in self.constraints],
            "ties": dict(self.ties),
            "priors": {name: list(pair) for name, pair in self.priors.items()},
            "noise_of_priors": None if prior is None else prior.noise,
            "loss": "squares" if loss is None else loss.name,
            "loss_scale": None if loss is None else loss.scale,
            "kkt_residual": self.optimality.residual,
        }


def solve_under(
    made: Model, problem: Problem, solution: Solution, errors: Errors, effort: Effort, seed: int
) -> tuple[Solution, Under]:
    """The best values under what is stated about the parameters of `made`.

    Parameters
    ----------
    problem
        With the load torque of the free solution.
    solution
        The best values within the bounds alone, which are the first start.

    Raises
    ------
    FitError
        No values hold the constraints.
    """
    lower, upper = solution.lower, solution.upper
    constraints = ParameterConstraints.of(made, solution.values)
    region = Region(lower, upper, Together((constraints,)), Ties.of(made))
    prior = Prior.of(made)
    objective = Objective(problem, prior if prior.places.size else None)
    found, objective, evaluations = _searched(objective, region, solution, errors, effort, seed)
    values, optimality, steps = polished(
        objective, found.values, region, most=MOST_POLISHING if effort.evaluations else 1
    )
    optimal = optimality.residual <= OPTIMAL
    solved = replace(
        solution,
        values=values,
        load=objective.problem.load,
        converged=optimal or (effort.evaluations == 0 and found.converged),
        outcome="converged" if optimal else "ended near a minimum, not at one",
        evaluations=solution.evaluations + evaluations + steps,
    )
    under = Under(objective, region, optimality, constraints, (), None)
    return solved, under.at(values, objective, region, optimality)


def prior_conflicts(problem: Problem, free: Array, under: Under, errors: Errors) -> tuple[str, ...]:
    """A sentence for each prior from which the data alone differs by more than 3 standard errors.

    Parameters
    ----------
    free : array [p]
        The best values without what is stated.
    """
    prior, region = under.objective.prior, under.region
    if prior is None:
        return ()
    by = Uncertainty("independent" if errors == "independent" else "robust")
    alone = identified(problem, free, region.lower, region.upper, by).estimates
    notes = []
    for name, (mean, deviation) in under.priors.items():
        e = alone[name]
        if e.stderr is None:
            continue
        apart = abs(e.value - mean) / float(np.hypot(e.stderr, deviation))
        if apart > CONFLICT:
            notes.append(
                f"the prior of {name}, {mean:.4g} +- {deviation:.3g}, is {apart:.1f} standard "
                f"errors from what the data shows, {e.value:.4g} +- {e.stderr:.3g}: correct it, or "
                f"leave it out"
            )
    return tuple(notes)


def _searched(
    objective: Objective,
    region: Region,
    solution: Solution,
    errors: Errors,
    effort: Effort,
    seed: int,
) -> tuple[Search, Objective, int]:
    """The best search, the objective with the levels found, and evaluations."""
    made = objective.problem.model
    loss = cast(LossName, made.stated.loss)
    start = region.filled(solution.values)
    # The Cauchy loss has several minima: the one near that of Huber's convex loss is sought.
    objective = _levelled(objective, start, region, errors, "huber" if loss == "cauchy" else loss)
    searches = [
        _minimised(objective, at, region) for at in _starts(objective, solution, effort, seed)
    ]
    evaluations = sum(search.evaluations for search in searches)
    best = min(searches, key=lambda search: search.square)
    if not np.isfinite(best.square):
        raise FitError(_impossible(made, region, start))
    for _ in range(MOST_ROUNDS):
        levelled = _levelled(objective, best.values, region, errors, loss)
        moved = _moved(objective, levelled)
        objective = levelled
        if moved <= STAYS:
            break
        best = _minimised(objective, best.values, region)
        evaluations += best.evaluations
    return best, objective, evaluations


def _minimised(objective: Objective, values: Array, region: Region) -> Search:
    return minimise_under(objective, values, region, settled=SETTLED, most=MOST_STEPS)


def _starts(objective: Objective, solution: Solution, effort: Effort, seed: int) -> list[Array]:
    """The free solution; then the means of priors, the typical start, and random ones."""
    problem = objective.problem
    starts = [solution.values]
    if objective.prior is not None:
        known = solution.values.copy()
        known[objective.prior.places] = objective.prior.mean
        starts.append(known)
    if effort.evaluations == 0:
        return starts
    typical = scaled_bounds(problem.model, problem.recording)[2]
    space = SearchSpace.of(problem, solution.lower, solution.upper)
    bounded = np.isfinite(solution.lower) & np.isfinite(solution.upper)
    starts.append(typical)
    if space.nonlinear.any() and bounded[space.nonlinear].all():
        random = np.random.default_rng(seed)
        starts += [space.drawn(typical, random) for _ in range(MORE_STARTS)]
    return starts


def _levelled(
    objective: Objective, values: Array, region: Region, errors: Errors, loss: LossName
) -> Objective:
    """The objective with the noise, the scale of the loss and the load torque at some values."""
    problem = objective.problem
    if needs_own_load(problem.model):
        load = own_load(problem.model.with_values(values), problem.recording)
        problem = replace(problem, load=load)
        objective = replace(objective, problem=problem)
    if loss == "squares" and objective.prior is None:
        return objective
    residual = objective.weighted_residual(values)
    residual = residual[problem.weighted(np.ones(residual.size)) > 0.0]
    # Exact data leaves nothing but rounding.
    least = float(np.finfo(float).eps) * problem.torque_norm / np.sqrt(residual.size)
    scale = max(robust_scale(residual), least)
    if loss != "squares":
        objective = replace(objective, loss=Loss(loss, scale))
    if objective.prior is None:
        return objective
    freedom = max(residual.size - region.free.size, 1)
    level = np.sqrt(residual @ residual / freedom) if loss == "squares" else scale
    length = 1.0 if errors == "independent" else correlation_length(residual)
    noise = max(float(level * np.sqrt(length)), least)
    return replace(objective, prior=replace(objective.prior, noise=noise))


def _moved(before: Objective, after: Objective) -> float:
    """Relative change of the levels of two objectives."""
    changes = [0.0]
    if after.loss is not None and before.loss is not None:
        other = 1.0 if after.loss.name != before.loss.name else 0.0
        changes.append(abs(after.loss.scale / before.loss.scale - 1.0) + other)
    if after.prior is not None and before.prior is not None:
        changes.append(abs(after.prior.noise / before.prior.noise - 1.0))
    new, old = after.problem.load, before.problem.load
    if new is not None and old is not None and new is not old:
        changes.append(rms(new - old) / (rms(new) or 1.0))
    return max(changes)


def _loss_weight(objective: Objective, values: Array) -> Array | None:
    if objective.loss is None:
        return None
    weight = np.ones(objective.problem.recording.rows)
    weight[objective.problem.rows] = objective.loss.weights(objective.weighted_residual(values))
    return weight


def _impossible(made: Model, region: Region, values: Array) -> str:
    shares, _ = region.finite_shares(values)
    texts = [text for text, _ in made.stated.constraints]
    worst = int(np.argmin(shares)) if shares.size else 0
    what = texts[worst] if worst < len(texts) else "a bound of a tied parameter"
    return (
        f"no values of {made.spec} within its bounds hold the constraints ({what}): change them, "
        f"or give other bounds ({option('bounds')})"
    )
