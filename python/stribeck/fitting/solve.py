"""Find the best parameters.

Friction that depends on an identified load torque is solved by fixed-point iteration.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.checks import check_count
from stribeck.effect.constants import effect_constants
from stribeck.identify.figures import rms
from stribeck.identify.left_out.torque_shift import with_shift
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds as scaled_bounds
from stribeck.identify.search.effort import Effort
from stribeck.identify.search.ends import Found
from stribeck.identify.search.many_starts import multi_start
from stribeck.identify.search.separable import minimise
from stribeck.models.catalog import catalog
from stribeck.models.model import Model
from stribeck.models.rigid_body import needs_own_load, own_load
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass
class Solution:
    values: Array
    load: Array | None
    lower: Array
    upper: Array
    starts: int
    converged: bool
    outcome: str
    evaluations: int
    found: Found


def with_own_load(
    made: Model,
    recording: Recording,
    rows: NDArray[np.intp],
    starts: int,
    seed: int,
    effort: Effort,
) -> tuple[Model, Array | None]:
    """A first estimate of the load torque, from a fit of friction without load dependence."""
    if not needs_own_load(made):
        return made, None
    plain = made if np.all(np.isfinite(made.values)) else _without_load(made)
    if not np.all(np.isfinite(plain.values)):
        solved = solve(plain, recording, rows, None, min(starts, 4), seed, effort)
        plain = plain.with_values(solved.values)
    load = own_load(plain, recording)
    constants = dict(made.constants)
    if "reference_load" not in constants or constants["reference_load"] == 1.0:
        constants.update(effect_constants("load", recording, load))
    return replace(made, constants=constants), load


def _without_load(model: Model) -> Model:
    """`model` without load-dependent effects; a load-dependent law is replaced by coulomb."""
    table = catalog()["effects"]
    reading = [e for e in model.effects if "load_torque" in table[e]["channels"]]
    reading += [terms.name for terms in model.own if "load_torque" in terms.channels]
    for effect in reading:
        model = model.without_effect(effect)
    if "load_torque" in model.core.needs:
        model = replace(model, law="coulomb", own=(), effects=(), values=np.empty(0))
    return model


def solve(
    made: Model,
    recording: Recording,
    rows: NDArray[np.intp],
    load: Array | None,
    starts: int,
    seed: int,
    effort: Effort,
) -> Solution:
    """Search the best values; iterate while friction depends on the identified rigid body."""
    check_count("starts", starts)
    lower, upper, first = scaled_bounds(made, recording)
    known = made.values
    # Known values keep their start in every search; only the others get random starts.
    unknown = ~np.isfinite(known)
    first = with_shift(first, unknown, made, recording)
    start = np.clip(np.where(unknown, first, known), lower, upper)
    problem = Problem(recording, made, rows, load)
    varied = unknown if unknown.any() else np.ones_like(unknown)
    found = multi_start(problem, lower, upper, start, varied, starts, seed, effort)
    search, evaluations = found.search, found.evaluations
    if load is not None and needs_own_load(made):
        for _ in range(8):
            renewed = own_load(made.with_values(search.values), recording)
            assert renewed is not None
            moved = rms(renewed - load) / (rms(renewed) or 1.0)
            load = renewed
            search = minimise(
                Problem(recording, made, rows, load),
                search.values,
                lower,
                upper,
                tolerance=effort.tolerance,
            )
            evaluations += search.evaluations
            if moved < 1e-5:
                break
    return Solution(
        search.values,
        load,
        lower,
        upper,
        len(found.ends),
        search.converged,
        search.outcome,
        evaluations,
        found,
    )
