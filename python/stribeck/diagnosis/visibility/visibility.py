"""What a recording could have shown: the smallest visible effects, and indistinguishable ones."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np

from stribeck.base.errors import StribeckError
from stribeck.base.pool import on_each
from stribeck.diagnosis.extend import holds
from stribeck.diagnosis.flexible_shape import flexible_columns
from stribeck.diagnosis.least_fall import reduced
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.visibility.added_effect import AddedEffect
from stribeck.diagnosis.visibility.groups import indistinguishable
from stribeck.diagnosis.visibility.model_space import ModelSpace
from stribeck.diagnosis.visibility.power import Demand, Noise
from stribeck.diagnosis.visibility.result import Visibility
from stribeck.diagnosis.visibility.smallest import VisibleEffect, smallest_visible
from stribeck.diagnosis.visibility.subspace import sine_to_span
from stribeck.effect.base import number
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.identify.errors.confounded import partners, reason
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.models.catalog import effect_row

#: Sine of the angle to a model from which it is not the model that hides an effect.
NOT_ABSORBED = 0.3


def visibility(
    fit: Fit,
    candidates: Iterable[str],
    *,
    found: Collection[str] = (),
    tried: int = 1,
    significance: float = 0.01,
    least_fall: float = 0.01,
) -> Visibility:
    """How visible `candidates`, effects that `fit` lacks, are on its recording beside its model.

    Parameters
    ----------
    found
        Effects that were found; they are considered for the groups only.
    tried, significance, least_fall
        What the diagnosis demands of a finding: significance over all effects tried, and the least
        relative fall of the held-out RMSE.
    """
    problem = problem_of(fit)
    model = ModelSpace(problem)
    noise = Noise.of(fit.residual[fit.rows])
    need = Demand(significance / max(tried, 1), least_fall)
    columns = flexible_columns(fit)
    models = [(model, need)]
    if columns.shape[1]:
        # What a flexible form of the effects in the model explains is not claimed for another.
        flexible = ModelSpace(problem, columns)
        models.append((flexible, replace(need, least_fall=reduced(need.least_fall))))
    unit, largest = fit.model.torque_unit, _friction(fit)

    def look(effect: str) -> VisibleEffect | None:
        try:
            added = AddedEffect.of(problem, effect, fit.residual)
            forms = of_catalog(effect).forms(fit.recording)
            return smallest_visible(added, models, noise, fit.prediction[fit.rows], forms)
        except StribeckError:
            return None

    visible, hidden = [], []
    effects = [one for one in on_each(look, candidates) if one is not None]
    for one in effects:
        if one.smallest <= largest:
            visible.append(one)
        elif one.effect not in found and one.is_tested(found) and not holds(fit.model, one.effect):
            hidden.append(_hidden(one, model, unit))
    smallest = sorted(
        (s.result(unit) for s in visible if s.effect not in found and s.is_tested(found)),
        key=lambda s: s.rms,
    )
    groups = indistinguishable(visible, problem, rms(noise.residual), unit)
    return Visibility(tuple(smallest), groups, tuple(hidden))


def problem_of(fit: Fit) -> Problem:
    """The problem that `fit` solves, with the load torque that an effect may depend on."""
    return Problem(fit.recording, fit.model, fit.rows, fit.own_load)


def _friction(fit: Fit) -> float:
    """RMS of the modelled friction: no addition is larger."""
    friction = fit.prediction - fit.recording.known_torque
    load = fit.own_load
    if load is not None:
        friction = friction - load
    return rms(friction[fit.rows])


def _hidden(one: VisibleEffect, space: ModelSpace, unit: str) -> Untestable:
    """Say why an effect as large as all friction would not be seen."""
    model = space.problem.model
    columns = np.column_stack([one.torque, space.columns])
    names = (one.effect, *(model.names[k] for k in space.free))
    alike = partners(columns, 0, np.ones(columns.shape[1], dtype=bool))
    why = reason(names, alike)
    if sine_to_span(one.torque, space.basis) > NOT_ABSORBED:
        why = (
            "a part of it shows in only one stretch of the recording, and a model fitted without "
            "that stretch cannot predict it"
        )
        return Untestable(one.effect, why, "repeat the motion, so that other stretches show it too")
    if np.isfinite(one.smallest):
        why = (
            f"it would only be found above {number(one.smallest, 2)} {unit} RMS, more than all the "
            f"friction ({why}, or nearly)"
        )
    row = effect_row(one.effect)
    needs = "other motion" if row is None else row["needs"]
    return Untestable(one.effect, why, f"record {needs}")
