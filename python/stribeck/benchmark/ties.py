"""Is a tie one by the information in the recording, or only by the test that found it?

A hidden effect that is reported as indistinguishable from others is so if one of them can replace
its torque: if the generator's own model, with the tangent space of the model that has the other
effect beside it, no longer detects the hidden one (Fisher information of its amplitude).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.benchmark.oracle import detection
from stribeck.benchmark.sample import Oracle

if TYPE_CHECKING:
    from stribeck.diagnosis.loop.improve import Improvement
    from stribeck.diagnosis.loop.path import ImprovementStep
    from stribeck.fitting.result import Fit

Array = NDArray[np.float64]


def apart(improvement: Improvement, oracle: Oracle, effect: str) -> float | None:
    """Standard errors by which a hidden effect stands out from the best of its reported ties.

    None where it is not reported as one of several.
    """
    found = [
        detection(oracle, effect, fit.recording.torque, _mask(fit), _tangent(fit))
        for step in improvement.steps
        if effect in _names(step) and len(_names(step)) > 1
        for fit in _with_each_rival(improvement.final, step, effect)
    ]
    return min(found, default=None)


def _names(step: ImprovementStep) -> tuple[str, ...]:
    return (step.finding.effect, *step.finding.indistinguishable_from)


def _with_each_rival(final: Fit, step: ImprovementStep, effect: str) -> list[Fit]:
    """The final model, with each other effect of a tie in the place of the one that is named."""
    from stribeck.diagnosis.loop.superfluous import fit_without
    from stribeck.diagnosis.trials.screening import screened
    from stribeck.diagnosis.trials.trial import try_effect

    made = [] if step.finding.effect == effect else [final]
    others = [e for e in step.finding.indistinguishable_from if e != effect]
    without = fit_without(final, step.finding, 0) if others else None
    for other in others:
        found = None if without is None else screened(without, other)
        trial = None if without is None or found is None else try_effect(without, found)
        made += [] if trial is None else [trial.fit]
    return made


def _mask(fit: Fit) -> NDArray[np.bool_]:
    """The samples fitted to, bool [n]."""
    chosen = np.zeros(fit.recording.rows, dtype=bool)
    chosen[fit.rows] = True
    return chosen


def _tangent(fit: Fit) -> Array:
    """Derivatives of the torque by each parameter, on the samples fitted to, array [m, p]."""
    from stribeck.identify.problem import Problem

    problem = Problem(fit.recording, fit.model, fit.rows, fit.load)
    return problem.linearise(fit.model.values)[1]
