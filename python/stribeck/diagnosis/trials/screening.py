"""Which effects are worth a full fit: a few steps on a few samples.

Most effects of the catalog explain nothing on a given recording, and some thousands of samples
show this as well as all do. The search of each effect starts from the values of the model and from
several values of the effect's nonlinear parameters. A full fit of a promising effect continues from
the best result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.base.memo import Memo
from stribeck.diagnosis.extend import extended_models
from stribeck.effect.registry import find
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.identify.held_out import held_out_residual
from stribeck.identify.left_out.torque_shift import with_shift
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search.delays import across_samples, free_delay
from stribeck.identify.search.separable import CAUTIOUS, Search, minimise_from
from stribeck.identify.search.space import SearchSpace
from stribeck.models.model import Model
from stribeck.models.rigid_body import own_load

Array = NDArray[np.float64]

#: Starts of an effect's nonlinear parameters; the others start from the fit before.
STARTS = 6
#: The same where every start simulates a state over the whole recording.
STARTS_ON_ALL_ROWS = 3
#: Samples of a memoryless model, and of the stretch on which a new state is tried.
ROWS, SAMPLES = 3000, 6000
#: Steps from each start, and further steps from the best of them.
FIRST_STEPS, FURTHER_STEPS = 3, 20
#: The further steps on all samples: the full fit continues from there.
FURTHER_STEPS_ON_ALL_ROWS = 4
#: A search whose squared error falls by this share in as many more steps is on its way.
FALLS = 0.01
#: A search ends at a step that predicts a smaller relative fall of the squared error.
TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Screened:
    """An effect after a few steps.

    Attributes
    ----------
    effect : str
        An id, or ``"NAME = FORMULA"``.
    model : Model
        The wider model with the values found.
    fall : float
        Relative fall of the RMSE on these samples; held out, where they come from all blocks.
    """

    effect: str
    model: Model
    fall: float


#: What was screened beside a fit.
_SCREENED: Memo[Fit, Screened | None] = Memo()


def extended_model(before: Fit, effect: str) -> Model:
    """`before`'s model with `effect` added, and the simpler effect that it contains.

    Raises
    ------
    SpecError
        The effect is unknown, or in the model already.
    """
    load = own_load(before.model, before.recording)
    return extended_models(before.model, effect, before.recording, load, before.residual)[-1]


def problem_of(model: Model, before: Fit) -> Problem:
    """The problem of another model on the samples of a fit, with its load torque and weights."""
    own, weight = before.own_load, before.loss_weight
    return Problem(before.recording, model, before.rows, own, loss_weight=weight)


def screened(before: Fit, effect: str, *, seed: int = 0) -> Screened | None:
    """Try `effect` on few samples; None where the model cannot take it.

    The same effect beside the same fit is tried once.
    """
    return _SCREENED.of(before, (effect, seed), lambda: _screened(before, effect, seed))


def _screened(before: Fit, effect: str, seed: int) -> Screened | None:
    known = find(effect)
    if known is not None and known.absorbed(before.model, before.recording) is not None:
        return None
    try:
        model = model_for(extended_model(before, effect), before.recording)
        base = _without_memory(before.model)
        problem = _few_samples(_memory_held(problem_of(model, before), before, base), base)
        lower, upper, first = bounds(problem.model, before.recording)
        found = _search(problem, lower, upper, first, seed)
        if not np.isfinite(found.square):
            return None
        fall = _fall(before, base, problem, found, lower, upper)
    except StribeckError:
        return None
    values = dict(zip(problem.model.names, found.values, strict=True))
    found_or_held = [values.get(name, model.value(name)) for name in model.names]
    return Screened(effect, model.with_values(found_or_held), fall)


def _memory_held(problem: Problem, before: Fit, base: Model) -> Problem:
    """The problem without the effects of `before` through which earlier samples act.

    Their part of the torque is held: with them, every step of a search would need all samples.
    """
    if base is before.model:
        return problem
    held = before.prediction - replace(problem, model=base).predict(base.values)
    model = problem.model
    for effect in set(before.model.effects).difference(base.effects):
        model = model.without_effect(effect)
    return replace(problem, model=model, held=held)


def _without_memory(model: Model) -> Model:
    """The model without the effects through which earlier samples act."""
    for effect in model.effects:
        alone = replace(model, law="coulomb", effects=(effect,), own=(), values=np.empty(0))
        if not alone.memoryless:
            model = model.without_effect(effect)
    return model


def _fall(
    before: Fit, base: Model, problem: Problem, found: Search, lower: Array, upper: Array
) -> float:
    """Relative fall of the RMSE; on a single stretch, with both models fitted to it alone."""
    if problem.span is None:
        level = rms(problem.weighted(before.held_out_residual[problem.rows]))
        left = rms(problem.weighted(held_out_residual(problem, found.values, lower, upper)))
    else:
        least, most, _ = bounds(base, before.recording)
        simpler = replace(problem, model=base)
        level = np.sqrt(_steps(simpler, base.values[None, :], least, most, FIRST_STEPS)[0].square)
        left = np.sqrt(found.square)
    return 1.0 - float(left / level) if level > 0.0 else 0.0


def _few_samples(problem: Problem, base: Model) -> Problem:
    """Few samples of a memoryless model; for a new state, the stretch with the most reversals.

    All samples for a delay, which may show anywhere, and for any effect beside the state of a law.
    """
    if problem.model.memoryless:
        return problem.thinned(ROWS)
    is_new_state = problem.model.has_state and not base.has_state
    return problem.window(SAMPLES) if is_new_state else problem


def _search(problem: Problem, lower: Array, upper: Array, first: Array, seed: int) -> Search:
    """The best search: from the known values, with several starts of the unknown ones."""
    known = problem.model.values
    unknown = ~np.isfinite(known)
    first = with_shift(first, unknown, problem.model, problem.recording)
    # With a bristle, a search finds the amplitudes of dry friction from any start but zero, where
    # the bristle has no influence.
    amplitude = np.array([p.role == "dry" for p in problem.model.parameters])
    idle = amplitude & (known == 0.0) & problem.model.has_state
    start = np.clip(np.where(unknown | idle, first, known), lower, upper)
    space = SearchSpace.of(problem, lower, upper)
    nonlinear = space.nonlinear
    varied = unknown & nonlinear & ~amplitude
    if not np.all(np.isfinite(lower[nonlinear]) & np.isfinite(upper[nonlinear])):
        varied = np.zeros_like(varied)
    random = np.random.default_rng(seed)
    few = problem.model.memoryless or problem.rows.size <= SAMPLES
    starts = STARTS if few else STARTS_ON_ALL_ROWS
    at = np.tile(start, (starts if varied.any() else 1, 1))
    for drawn in at[1:]:
        drawn[varied] = space.drawn(start, random)[varied]
    tried = _steps(problem, at, lower, upper, FIRST_STEPS)
    best = [min(tried, key=lambda search: search.square)]
    if not nonlinear.any():
        return best[0]
    if few and not problem.model.memoryless:
        best += _on_their_way(problem, tried, lower, upper)
    further = FURTHER_STEPS if few else FURTHER_STEPS_ON_ALL_ROWS
    went = _steps(problem, np.array([search.values for search in best]), lower, upper, further)
    found = min(went, key=lambda search: search.square)
    is_new_delay = unknown & free_delay(problem, lower, upper)
    if not is_new_delay.any() or problem.model.has_state:
        return found
    return across_samples(
        problem, found, lower, upper, lambda at: _steps(problem, at, lower, upper, FIRST_STEPS)
    )


def _on_their_way(
    problem: Problem, tried: Sequence[Search], lower: Array, upper: Array
) -> list[Search]:
    """The best search whose error still falls, if there is one.

    A start on the plateau where a state has no influence ends there, below those on their way.
    """
    at = np.array([search.values for search in tried])
    later = _steps(problem, at, lower, upper, FIRST_STEPS)
    falling = [
        after
        for before, after in zip(tried, later, strict=True)
        if after.square < (1.0 - FALLS) * before.square
    ]
    return sorted(falling, key=lambda search: search.square)[:1]


def _steps(problem: Problem, at: Array, lower: Array, upper: Array, most: int) -> list[Search]:
    """Searches from `at`, array [k, p]."""
    return minimise_from(
        problem, at, lower, upper, tolerance=TOLERANCE, most=most, damping=CAUTIOUS
    )
