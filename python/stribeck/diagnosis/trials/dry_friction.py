"""Dry friction that a law by formula lacks.

It comes before every other effect. A load or a position dependence, a Stribeck curve or a bristle
changes dry friction; without it in the model, they imitate it. A model that holds a term holds what
the term changes (marginality: Nelder 1977, J. R. Stat. Soc. A 140, 48-77).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from stribeck.diagnosis.trials.trial import Trial
from stribeck.models.catalog import check_effect
from stribeck.models.formula_law import effect_name, effect_terms
from stribeck.models.model import Model

#: Dry friction as an effect by formula.
DRY = "dry = c*sgn(v)"


def check_rejected(effects: Collection[str]) -> None:
    """Raise `SpecError` unless every one of `effects` may be a candidate of its own accord."""
    for effect in effects:
        if effect != effect_name(DRY):
            check_effect(effect)


def spelled_out(effect: str) -> str:
    """The text that adds an effect to a model: ``dry`` stands for its formula."""
    return DRY if effect == effect_name(DRY) else effect


def lacks_dry_friction(model: Model) -> bool:
    """Whether a model has no dry friction that the speed alone decides; laws of the catalog do."""
    return model.by_formula and not any(terms.has_dry_friction for terms in model.own)


def dry_friction_for(model: Model, given: Collection[str]) -> tuple[str, ...]:
    """Dry friction as a candidate, where a model lacks it and no formula `given` holds it."""
    taken = {*(effect_name(effect) for effect in given), *model.names}
    if not lacks_dry_friction(model) or effect_name(DRY) in taken:
        return ()
    return () if any(effect_terms(text).has_dry_friction for text in given) else (DRY,)


def is_missing_dry_friction(trial: Trial, model: Model) -> bool:
    """Whether a trial adds the dry friction that a model lacks."""
    own = trial.fit.model.formula(trial.effect)
    return own is not None and own.has_dry_friction and lacks_dry_friction(model)


def dry_friction_first(trials: Sequence[Trial], model: Model) -> list[Trial]:
    """The same trials, that of the dry friction which the model lacks first."""
    return sorted(trials, key=lambda trial: not is_missing_dry_friction(trial, model))
