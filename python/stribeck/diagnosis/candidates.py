"""The effects that are tried on a recording, and those that pass."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial

from stribeck.base.pool import on_threads
from stribeck.diagnosis.beside import FreerShape
from stribeck.diagnosis.screen import screened
from stribeck.diagnosis.testable import Untestable, untestable
from stribeck.diagnosis.trial import (
    Trial,
    instead_of,
    passes,
    promises,
    reported_fall,
    try_beyond,
    try_effect,
)
from stribeck.diagnosis.widen import contained
from stribeck.fitting.result import Fit
from stribeck.fitting.rigid_body import own_load
from stribeck.identify.scaling import check_channels
from stribeck.models.catalog import effect_ids
from stribeck.models.formula_law import effect_name


@dataclass(frozen=True)
class Candidates:
    """What can be tried on a fitted model.

    Attributes
    ----------
    possible
        Effects, ids or ``"NAME = FORMULA"``, that the recording can show and the model lacks.
    untestable
        Effects that the recording cannot show.
    """

    possible: tuple[str, ...]
    untestable: tuple[Untestable, ...]


def candidates_for(fitted: Fit, rejected: Collection[str], more: Collection[str]) -> Candidates:
    """The catalog's effects and `more` by formula, without those `rejected`."""
    recording, model = fitted.recording, fitted.model
    cannot = untestable(recording, own_load(model, recording))
    inside = {*model.effects, *model.rigid_body, *model.own_effects}
    for effect in more:
        if effect_name(effect) not in inside:
            check_channels(model.with_effect(effect, {}), recording)
    possible = tuple(
        effect
        for effect in (*effect_ids(), *more)
        if not {effect_name(effect)} & {*inside, *cannot, *rejected}
    )
    hidden = tuple(row for effect, row in cannot.items() if effect not in inside)
    return Candidates(possible, hidden)


def tried_on(
    fitted: Fit, possible: Collection[str], least: float, seed: int
) -> tuple[list[Trial], int]:
    """Trials that pass, the best first, and how many effects were looked at.

    An effect that contains a simpler one is tried on top of it, where that one passes. If another
    effect does the same there with fewer parameters, those two take its place: the larger of them.
    """
    alone = [effect for effect in possible if contained(effect, fitted.model) is None]
    with on_threads() as pool:
        looked_at = [s for s in pool.map(partial(screened, fitted, seed=seed), alone) if s]
        promising = [s for s in looked_at if promises(s, least)]
        trials = [t for t in pool.map(partial(try_effect, fitted), promising) if t]
    tried = max(len(looked_at), 1)
    good = [t for t in trials if passes(t, tried, least)]
    pairs: list[_Pair] = []
    for effect in possible:
        simpler = next((t for t in good if t.effect == contained(effect, fitted.model)), None)
        if simpler is None:
            continue
        beyond = try_beyond(simpler, effect, fitted, least, seed=seed)
        if beyond is None or not passes(beyond[0], tried, least):
            continue
        others = [t for t in good if t is not simpler]
        other = instead_of(beyond[1], simpler, others, fitted, least, seed)
        if other is not None:
            pairs.append(_Pair(beyond[1], min(simpler, other, key=lambda trial: trial.rank)))
        elif passes(beyond[1], tried, least):
            good.append(beyond[1])
    good = [t for t in good if reported_fall(fitted, t)]
    shape = FreerShape.of(fitted) if good else None
    if shape is not None:
        good = [t for t in good if not shape.explains(t, tried, least)]
    good.sort(key=lambda trial: trial.rank)
    for pair in pairs:
        if pair.larger in good and pair.together.rank < good[0].rank:
            good.sort(key=lambda trial: trial is not pair.larger)
    return good, tried


@dataclass(frozen=True)
class _Pair:
    """Two effects that do what a wider one does, and the larger of the two."""

    together: Trial
    larger: Trial
