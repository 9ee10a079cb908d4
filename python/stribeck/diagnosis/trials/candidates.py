"""The effects that are tried on a recording, and those that pass."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import partial

from stribeck.base.pool import on_each, on_threads
from stribeck.diagnosis.extend import missing_simpler_effect, needs_simpler_effect
from stribeck.diagnosis.testable import Untestable, untestable
from stribeck.diagnosis.trials.dry_friction import (
    dry_friction_first,
    dry_friction_for,
    is_missing_dry_friction,
)
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from stribeck.diagnosis.trials.screening import Screened, screened
from stribeck.diagnosis.trials.told import Told
from stribeck.diagnosis.trials.trial import (
    Trial,
    falls_on_all_samples,
    is_promising,
    is_uncertain,
    passes,
    passes_at_a_bound,
    passes_in_one_block,
    passes_outside_the_band,
    simpler_substitute,
    try_beyond,
    try_effect,
)
from stribeck.fitting.result import Fit
from stribeck.identify.scaling import check_channels
from stribeck.models.catalog import effect_ids
from stribeck.models.formula_law import effect_name
from stribeck.models.rigid_body import own_load


@dataclass(frozen=True)
class Candidates:
    """The effects that can be tried on a fitted model.

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
    """The catalog's effects and `more` by formula, without those `rejected`.

    Dry friction is one of them where the law, a formula, has none.
    """
    recording, model = fitted.recording, fitted.model
    cannot = untestable(recording, own_load(model, recording), model)
    inside = {*model.effects, *model.rigid_body, *model.own_effects}
    for effect in more:
        if effect_name(effect) not in inside:
            check_channels(model.with_effect(effect, {}), recording)
    possible = tuple(
        effect
        for effect in (*effect_ids(), *more, *dry_friction_for(model, more))
        if not {effect_name(effect)} & {*inside, *cannot, *rejected}
    )
    hidden = tuple(row for effect, row in cannot.items() if effect not in inside)
    return Candidates(possible, hidden)


@dataclass(frozen=True)
class Tested:
    """What passes the test of evidence.

    Attributes
    ----------
    passing
        Trials that pass, the best first.
    in_one_block
        Trials that would pass, but gain in one block alone.
    outside_the_band
        Trials that would pass, but gain only at frequencies above those of the motion.
    uncertain
        Trials that predict better in most blocks, but not by more than chance may.
    explained
        Trials that pass, but add nothing where the effects of the model may take any smooth form.
    at_bound
        Trials that would pass, but whose size is at its bound.
    screenings
        Each effect that was screened.
    """

    passing: list[Trial]
    in_one_block: list[Trial]
    outside_the_band: list[Trial]
    uncertain: list[Trial]
    explained: list[Trial]
    at_bound: list[Trial]
    screenings: Mapping[str, Screened]

    @property
    def screened(self) -> int:
        """Number of effects that were screened."""
        return max(len(self.screenings), 1)


def tested(
    fitted: Fit,
    possible: Collection[str],
    least: float,
    seed: int,
    progress: Callable[[str], None] = lambda sentence: None,
) -> Tested:
    """Screen and try effects, and test each.

    An effect that contains a simpler one is tried beside it. It must add to that, and pass together
    with it, which need not pass alone. If another effect does as well there with fewer parameters,
    the pair replaces it: the larger of the two comes first. An effect that does not need the
    simpler one is compared with others later, as those are with each other.
    """
    needs = {effect: missing_simpler_effect(effect, fitted.model) for effect in possible}
    alone = [effect for effect, needed in needs.items() if needed is None]
    first = _tried_alone(fitted, alone, least, seed, progress)
    tried = max(len(first.screenings), 1)
    good = [t for t in first.trials if passes(t, tried, least)]
    pairs: list[_Pair] = []
    for effect, needed in needs.items():
        simpler = None if needed is None else first.of_simpler(effect, needed)
        if simpler is None:
            continue
        beyond = try_beyond(simpler, effect, fitted, least, seed=seed)
        if beyond is None or not passes(beyond[0], tried, least):
            continue
        instead = None
        if needs_simpler_effect(effect):
            others = [t for t in good if t is not simpler]
            instead = simpler_substitute(beyond[1], simpler, others, alone, fitted, least, seed)
        if instead is not None:
            pairs.append(_Pair(beyond[1], min(instead, key=lambda trial: trial.rank)))
        elif passes(beyond[1], tried, least):
            good.append(beyond[1])
    good = [t for t in good if falls_on_all_samples(fitted, t)]
    explained = _explained(fitted, good, tried, least)
    good = [t for t in good if t not in explained]
    good.sort(key=lambda trial: trial.rank)
    for pair in pairs:
        if pair.larger in good and pair.together.rank < good[0].rank:
            good.sort(key=lambda trial: trial is not pair.larger)
    in_one_block = [t for t in first.trials if passes_in_one_block(t, tried, least)]
    outside = [t for t in first.trials if passes_outside_the_band(t, tried, least)]
    uncertain = [t for t in first.trials if is_uncertain(t, tried, least)]
    at_bound = [t for t in first.trials if passes_at_a_bound(t, tried, least)]
    passing = dry_friction_first(good, fitted.model)
    return Tested(passing, in_one_block, outside, uncertain, explained, at_bound, first.screenings)


def _explained(fitted: Fit, good: list[Trial], tried: int, least: float) -> list[Trial]:
    """Trials that add nothing where the effects of the model may take any smooth form."""
    flexible = FlexibleRefit.of(fitted) if good else None
    if flexible is None:
        return []
    effects = [t for t in good if not is_missing_dry_friction(t, fitted.model)]
    explained = on_each(lambda trial: flexible.explains(trial, tried, least), effects)
    return list(itertools.compress(effects, explained))


@dataclass(frozen=True)
class _TriedAlone:
    """Effects that were tried alone: all but those that contain a simpler one.

    Attributes
    ----------
    screenings
        The screening of each.
    trials
        Trials of the promising ones.
    """

    fitted: Fit
    least: float
    seed: int
    screenings: Mapping[str, Screened]
    trials: list[Trial]

    def of_simpler(self, effect: str, needed: str) -> Trial | None:
        """The trial of the simpler effect that another contains.

        It is tried, though it promises nothing alone, where the wider one is promising.
        """
        made = next((t for t in self.trials if t.effect == needed), None)
        if made is not None or needed not in self.screenings:
            return made
        wider = screened(self.fitted, effect, seed=self.seed)
        if wider is None or not is_promising(wider, self.least):
            return None
        return try_effect(self.fitted, self.screenings[needed])


def _tried_alone(
    fitted: Fit,
    alone: Collection[str],
    least: float,
    seed: int,
    progress: Callable[[str], None],
) -> _TriedAlone:
    """Screen the effects of `alone`, and try the promising ones."""
    with on_threads() as pool:
        each = zip(alone, pool.map(partial(screened, fitted, seed=seed), alone), strict=True)
        screenings = {effect: screening for effect, screening in each if screening}
        promising = [s for s in screenings.values() if is_promising(s, least)]
        progress(f"  {len(promising)} of {len(screenings)} effects are promising")
        trials: list[Trial] = []
        told = Told(progress, len(promising))
        made = zip(promising, pool.map(partial(try_effect, fitted), promising), strict=True)
        for screening, trial in made:
            told.fitted(effect_name(screening.effect), trial)
            trials += [trial] if trial else []
    return _TriedAlone(fitted, least, seed, screenings, trials)


@dataclass(frozen=True)
class _Pair:
    """Two effects that replace a wider one, and the larger of the two."""

    together: Trial
    larger: Trial
