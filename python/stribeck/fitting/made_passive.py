"""Refit under passivity conditions, and state what they cost."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.finish import finish
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.result import Fit
from stribeck.fitting.solve import Solution
from stribeck.fitting.stated import Under
from stribeck.identify.constrained.conditions import Together
from stribeck.identify.constrained.minimise import Conditioned
from stribeck.identify.constrained.objective import Objective
from stribeck.identify.constrained.optimality import polished
from stribeck.identify.constrained.region import Region
from stribeck.identify.errors.uncertainty import Uncertainty
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.search.effort import Effort
from stribeck.models.rigid_body import needs_own_load, own_load
from stribeck.passivity.imposed import Passive, PassiveCost, impose

Array = NDArray[np.float64]


def made_passive(free: Fit, solution: Solution, effort: Effort) -> Fit:
    """Refit under passivity conditions; `free` is returned if it is passive already."""
    if free.passive():
        cost = PassiveCost(False, free.rmse, free.rmse_held_out, 0, 0.0)
        return replace(free, passive_cost=cost)
    began = time.perf_counter()
    recording, rows = free.recording, free.rows

    def renewed(problem: Problem, values: Array) -> Problem:
        if not needs_own_load(free.model):
            return problem
        load = own_load(free.model.with_values(values), recording)
        return replace(problem, load=load)

    objective, region = _as_stated(free, solution)
    found = impose(
        objective,
        solution.values,
        scaled_bounds(free.model, recording)[2],
        region,
        box_of=lambda at, load: operating_box(free.model.with_values(at), recording, load),
        renewed=renewed,
    )
    held = replace(
        solution,
        values=found.values,
        load=found.problem.load,
        converged=found.converged,
        outcome="converged under passivity conditions" if found.converged else "not converged",
        evaluations=solution.evaluations + found.evaluations,
    )
    within = replace(region, conditions=Together((region.conditions, found.conditions)))
    cost = PassiveCost(
        True,
        free.rmse,
        free.rmse_held_out,
        len(found.conditions.requirements),
        found.conditions.reserve,
    )
    seconds = free.seconds + time.perf_counter() - began
    fitted = finish(
        free.model.with_values(found.values),
        recording,
        free.transient,
        rows,
        held.load,
        held,
        effort,
        Uncertainty(free.errors),
        seconds,
        by=Conditioned(replace(objective, problem=found.problem), within),
        under=None if free.under is None else _under(free.under, found, within),
    )
    return replace(fitted, passive_cost=cost)


def _as_stated(free: Fit, solution: Solution) -> tuple[Objective, Region]:
    """What a fit minimised, and where."""
    if free.under is not None:
        return free.under.objective, free.under.region
    problem = Problem(free.recording, free.model, free.rows, free.load)
    return Objective(problem), Region(solution.lower, solution.upper)


def _under(stated: Under, found: Passive, region: Region) -> Under:
    """What is stated, together with the conditions of passivity."""
    objective = replace(stated.objective, problem=found.problem)
    _, optimality, _ = polished(objective, found.values, region, most=1)
    return stated.at(found.values, objective, region, optimality)
