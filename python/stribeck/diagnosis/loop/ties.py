"""The ties of the findings, judged again in the last model.

A step states the effects that predict as well as its own beside what was known then. Beside the
effects of later steps one of them may predict worse, or be in the model itself. Friction may also
imitate another kind of cause whose formula in the catalog fits worse than its own: there the free
forms of both are compared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

from stribeck.base.pool import on_each
from stribeck.diagnosis.flexible_shape import columns_of
from stribeck.diagnosis.loop.exchange import PROMISE
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep
from stribeck.diagnosis.loop.provisional import judged
from stribeck.diagnosis.loop.superfluous import brought_by, fit_without
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.beside_structure import is_undecided
from stribeck.diagnosis.trials.evidence import (
    Difference,
    difference,
    evidence,
    held_out_square,
)
from stribeck.diagnosis.trials.flexible_refit import Array, FlexibleRefit, free_square
from stribeck.diagnosis.trials.imitations import NARROW, most_certain
from stribeck.diagnosis.trials.proxies import alike, fits_exactly
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, TIE, Trial, tie_weight, try_effect
from stribeck.effect.describe import is_drive_train, is_friction
from stribeck.effect.load_parts import SCALE
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_ids

#: Share of what an effect explains alone that it explains beside another one, from which the other
#: is no tie: both are missing.
APART = 0.8
#: The effect by which all torque is late, and not that of a Stribeck curve alone.
DELAY = "delay"


def settled(path: ImprovementPath, least: float, seed: int) -> ImprovementPath:
    """The path with the ties that its last model leaves open.

    An effect that loses a tie must pass all tests there, beside the others, and is then no surer
    than one that stands by little.
    """
    remains = path.last.unexplained
    left = (remains.share or 0.0) if remains.is_structure else 0.0

    def made_of(step: ImprovementStep) -> Finding:
        finding = _settled(step, path.current, left, least, seed)
        return _beside_measurement(finding, path.current, seed)

    made = on_each(made_of, path.steps)
    for step, finding in zip(path.steps, made, strict=True):
        if finding is not step.finding:
            path = path.with_instead(finding)
    return path


def _settled(
    step: ImprovementStep, current: Fit, structure: float, least: float, seed: int
) -> Finding:
    """The finding of a step with the ties that the model `current` leaves open.

    Parameters
    ----------
    structure
        Structure that remains, as a share of the squared held-out error; without it the forms of
        effects tell them apart.
    """
    finding = step.finding
    inside = {*current.model.effects, *current.model.own_effects}
    ties = [name for name in finding.indistinguishable_from if name not in inside]
    others = _Others(finding, current, structure, seed)
    unknown = alike(finding.effect, finding.before, current)
    kind = is_friction(finding.effect)
    rivals = [name for name in step.rivals if is_friction(name) != kind and name not in inside]
    possible = dict.fromkeys((*ties, *unknown, *rivals))
    weights = {
        name: 1.0 if name in unknown else others.weight(name, 0.0 if name in ties else PROMISE)
        for name in possible
    }
    if DELAY not in inside and (late := others.weight_of_delay()) > weights.get(DELAY, 0.0):
        weights[DELAY] = late
    left = {name: weight for name, weight in weights.items() if weight >= tie_weight(TIE)}
    # These are the same torque, however their errors differ behind different filters.
    most = 1.0 / (1.0 + sum(SCALE in (name, finding.effect) for name in unknown))
    if set(left) == set(finding.indistinguishable_from):
        return finding if finding.weight <= most else replace(finding, weight=most)
    if set(left) >= set(finding.indistinguishable_from):
        share = sum(weight for name, weight in left.items() if name not in ties)
        weight = finding.weight / (1.0 + share)
    elif judged(finding, current, least, seed) is not None:
        weight = max(finding.weight, NARROW) / (1.0 + sum(left.values()))
    else:
        left = {**dict.fromkeys(ties, 1.0), **left}
        weight = finding.weight
    return replace(finding, weight=min(weight, most), indistinguishable_from=tuple(left))


def _beside_measurement(finding: Finding, current: Fit, seed: int) -> Finding:
    """The finding, no surer than causes in the measurement leave it in the model `current`."""
    without = fit_without(current, finding, seed) if is_drive_train(finding.effect) else None
    if without is None:
        return finding
    trial = Trial(finding.effect, current, evidence(without, current))
    most = most_certain(trial, without)
    return replace(finding, weight=most) if most < finding.weight else finding


@dataclass(frozen=True)
class _Others:
    """Other effects in the place of one."""

    finding: Finding
    current: Fit
    structure: float
    seed: int

    @cached_property
    def without(self) -> Fit | None:
        """The last model without the one."""
        return fit_without(self.current, self.finding, self.seed)

    @cached_property
    def fits_exactly(self) -> bool:
        """Whether no structure remains, and the one has the very form of what is missing."""
        return self.structure == 0.0 and fits_exactly(self.finding.effect, self.current)

    @cached_property
    def free_square(self) -> Array:
        """Squared held-out residual [m] of the last model, its effects in their free forms."""
        return free_square(self.current)

    def weight(self, effect: str, promise: float) -> float:
        """How well another effect predicts: 1 as well, 0 far worse.

        Also 0 where its screening promises less than a share of what the one explains, its values
        cannot be right, the one explains nearly as much beside it as alone, or no structure remains
        and the one, which has the very form of what is missing, adds to it. A tie of the step,
        without a `promise`, may have any values.
        """
        by = self._instead(effect, promise)
        if by is None or self.without is None:
            return 0.0
        if promise > 0.0 and impossible(Claim(effect, self.without, by.fit)) is not None:
            return 0.0
        both = self._beside(by.fit)
        if both is not None and (self._adds_to_form(both) or self._is_apart(both, by.fit)):
            return 0.0
        effects, fits = (self.finding.effect, effect), (self.current, by.fit)
        if is_undecided(effects, fits, self.without, self.structure):
            return 1.0
        weight = tie_weight(difference(by.fit, self.current).statistic)
        if is_friction(effect) or not is_friction(self.finding.effect):
            return weight
        return max(weight, self._weight_in_free_form(by))

    def weight_of_delay(self) -> float:
        """How well the simpler part of the one and a delay of all torque predict in its place.

        0 where the one has no simpler part, as a frictional lag has its Stribeck curve.
        """
        simpler = [effect for effect in brought_by(self.finding) if effect != self.finding.effect]
        fit = self.without
        for effect in (*simpler, DELAY) if simpler else ():
            found = None if fit is None else screened(fit, effect, seed=self.seed)
            trial = None if fit is None or found is None else try_effect(fit, found)
            fit = None if trial is None or trial.is_implausible else trial.fit
        if not simpler or fit is None:
            return 0.0
        return tie_weight(difference(fit, self.current).statistic)

    def _weight_in_free_form(self, by: Trial) -> float:
        """The same of an effect with a free form, where those of both models have theirs."""
        free = FlexibleRefit.of(by.fit) if columns_of(by.effect, by.fit) else None
        if free is None:
            return 0.0
        return tie_weight(Difference.of(free.held_out**2 - self.free_square).statistic)

    def _instead(self, effect: str, promise: float) -> Trial | None:
        """Another effect in the place of the one; None where it promises too little."""
        without = self.without
        found = None if without is None else screened(without, effect, seed=self.seed)
        if without is None or found is None or found.fall < promise * self._needed(without):
            return None
        return try_effect(without, found)

    def _needed(self, without: Fit) -> float:
        """Relative fall of the held-out error that the one brings."""
        whole = held_out_square(without, self.current)
        left = held_out_square(self.current, self.current)
        return 1.0 - math.sqrt(left / whole) if whole > left else 0.0

    def _beside(self, before: Fit) -> Trial | None:
        """The one beside the effects of a fit."""
        effect = before.model.written(self.finding.effect)
        found = screened(before, effect, seed=self.seed)
        return None if found is None else try_effect(before, found)

    def _adds_to_form(self, both: Trial) -> bool:
        """Whether the one has the very form of what is missing, and adds to another effect."""
        return self.fits_exactly and both.evidence.p_value * len(effect_ids()) <= SIGNIFICANCE

    def _is_apart(self, both: Trial, other: Fit) -> bool:
        """Whether the one explains nearly as much beside another effect as without it."""
        if self.without is None:
            return False
        alone, beside = (
            held_out_square(before, self.current) - held_out_square(after, self.current)
            for before, after in ((self.without, self.current), (other, both.fit))
        )
        return alone > 0.0 and beside >= APART * alone
