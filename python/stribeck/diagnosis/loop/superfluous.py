"""Effects of a model that its recording does not need."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from stribeck.base.errors import StribeckError
from stribeck.base.memo import Memo
from stribeck.base.pool import on_each
from stribeck.diagnosis.least_fall import reduced
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.evidence import difference, evidence, held_out_square
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, SIMPLEST
from stribeck.effect.registry import of_catalog
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.identify.search.effort import QUICK
from stribeck.models.catalog import effect_ids
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

#: What a fit is without some of its effects.
_WITHOUT: Memo[Fit, Fit | None] = Memo()


def brought_by(finding: Finding) -> tuple[str, ...]:
    """The effect of a finding, and the simpler one that came with it."""
    before, after = finding.before.model, finding.fit.model
    present = {*before.effects, *before.own_effects}
    return tuple(e for e in (*after.effects, *after.own_effects) if e not in present)


def without_effects(model: Model, effects: Sequence[str]) -> Model:
    """The model without several of its effects, with the values of the others."""
    for effect in effects:
        model = model.without_effect(effect)
    return model


def without_influence(model: Model, recording: Recording) -> list[str]:
    """The effects that have no influence beside the others of a model."""
    return [e for e in model.effects if of_catalog(e).refusal(model, recording) is not None]


def model_without(current: Fit, finding: Finding) -> Model:
    """The model without what a finding brought, and without what has no influence then.

    The lag of a thermometer has none without friction that depends on temperature.
    """
    model = without_effects(current.model, brought_by(finding))
    return without_effects(model, without_influence(model, current.recording))


def fit_without(current: Fit, finding: Finding, seed: int) -> Fit | None:
    """The model refitted without what a finding brought; None where that cannot be fitted.

    An effect that has no influence without it is left out too. Each such model is fitted once: the
    tests of a path's last model ask for the same ones.
    """

    def refitted() -> Fit | None:
        try:
            return fit(
                model_without(current, finding),
                current.recording,
                starts=1,
                seed=seed,
                transient=current.transient,
                effort=QUICK,
            )
        except StribeckError:
            return None

    return _WITHOUT.of(current, (brought_by(finding), seed), refitted)


@dataclass(frozen=True)
class Needed:
    """How much each effect of a model is needed beside the others.

    Attributes
    ----------
    idle
        The effect without which the model predicts as well, if there is one; of several the one
        that is needed least.
    certainty
        For each effect the probability that the model predicts worse without it, 0..1.
    gain
        For each effect the rise of the squared held-out error without it, as a multiple of that of
        the model.
    """

    idle: str | None
    certainty: Mapping[str, float]
    gain: Mapping[str, float]


def needed(findings: Sequence[Finding], current: Fit, least: float, seed: int) -> Needed:
    """What the effects of some findings bring to a model that has all of them.

    One is idle where the error rises without it by less than half of `least`, by no more than noise
    explains, or the held-out error by no more than one standard error where it is not significant
    among all effects.
    """
    rises: dict[str, float] = {}
    certainty: dict[str, float] = {}
    gain: dict[str, float] = {}
    square = held_out_square(current, current)
    fits = on_each(lambda finding: fit_without(current, finding, seed), findings)
    for finding, without in zip(findings, fits, strict=True):
        if without is None:
            continue
        rows = current.rows
        level = rms(current.weighted(current.residual[rows]))
        rise = _rise(rms(current.weighted(without.residual[rows])), level)
        lost = difference(without, current)
        certainty[finding.effect] = lost.certainty
        gain[finding.effect] = _rise(held_out_square(without, current), square)
        chance = evidence(without, current).p_value
        # Among all effects a finding must be significant; there, it needs no further proof.
        doubtful = chance * len(effect_ids()) > SIGNIFICANCE
        if (
            rise < reduced(least)
            or chance > SIGNIFICANCE
            or (doubtful and lost.statistic <= SIMPLEST)
        ):
            rises[finding.effect] = lost.statistic
    return Needed(min(rises, key=lambda e: rises[e]) if rises else None, certainty, gain)


def _rise(after: float, before: float) -> float:
    """Relative rise of an error; infinite from an error of 0."""
    if before > 0.0:
        return after / before - 1.0
    return math.inf if after > 0.0 else 0.0
