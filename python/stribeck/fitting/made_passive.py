"""Refit under passivity conditions, and state what they cost."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.finish import finish
from stribeck.fitting.operating_box import operating_box
from stribeck.fitting.result import Fit
from stribeck.fitting.rigid_body import needs_own_load, own_load
from stribeck.fitting.solve import Solution
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.search import Effort
from stribeck.passivity.constrained import Conditioned
from stribeck.passivity.imposed import PassiveCost, impose

Array = NDArray[np.float64]


def made_passive(free: Fit, solution: Solution, effort: Effort) -> Fit:
    """Refit under passivity conditions; `free` is returned if it is passive already."""
    if free.passive():
        cost = PassiveCost(False, free.rmse, free.rmse_held_out, 0, 0.0)
        return replace(free, passive_cost=cost)
    began = time.perf_counter()
    recording, rows = free.recording, free.rows
    lower, upper = solution.lower, solution.upper

    def renewed(problem: Problem, values: Array) -> Problem:
        if not needs_own_load(free.model):
            return problem
        load = own_load(free.model.with_values(values), recording)
        return Problem(recording, free.model, rows, load)

    found = impose(
        Problem(recording, free.model, rows, free.load),
        solution.values,
        scaled_bounds(free.model, recording)[2],
        lower,
        upper,
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
        free.errors,
        seconds,
        by=Conditioned(lower, upper, found.conditions),
    )
    return replace(fitted, passive_cost=cost)
