"""Exchange of one effect of a model for another: greedy steps go wrong where causes share a shape.

A step takes the effect that predicts best alone. Once others are in the model, another may take its
place. Whole models are compared: by held-out error, and within one standard error by the number of
parameters and by the kind of the cause.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from stribeck.base.pool import on_each
from stribeck.diagnosis.flexible_shape import columns_of
from stribeck.diagnosis.loop.superfluous import brought_by, fit_without
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import impossible, weak
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.evidence import difference, held_out_square
from stribeck.diagnosis.trials.flexible_refit import free_difference
from stribeck.diagnosis.trials.imitations import NARROW, standing
from stribeck.diagnosis.trials.known_size import has_known_size
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.sifting import Sifted
from stribeck.diagnosis.trials.trial import (
    SIGNIFICANCE,
    SIMPLEST,
    TIE,
    Trial,
    tie_statistic,
    tie_weight,
    try_effect,
)
from stribeck.effect.describe import is_friction
from stribeck.effect.load_parts import HOLDS
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_ids, simpler_effect
from stribeck.models.formula_law import effect_name

#: Rivals of each effect that are tried.
MOST = 3
#: Share of what an effect explains that its screening on few samples must promise of a rival.
PROMISE = 0.8


@dataclass(frozen=True)
class Exchange:
    """An effect that may take the place of another.

    Attributes
    ----------
    finding
        The finding whose effect is replaced.
    without
        The model without it.
    by
        The other effect added to that.
    apart
        Standard errors by which the held-out errors of both models differ.
    most
        The highest confidence that the other effect may have.
    """

    finding: Finding
    without: Fit
    by: Trial
    apart: float
    most: float = 1.0


@dataclass(frozen=True)
class Exchanges:
    """What the exchange of single effects shows.

    Attributes
    ----------
    best
        The exchange with the smallest held-out error of those to be made.
    ties
        For each effect the others that predict as well in its place with no more parameters, or
        better with more, and their weights.
    """

    best: Exchange | None
    ties: Mapping[str, Mapping[str, float]]


def exchanges(
    findings: Sequence[Finding],
    rivals: Sequence[Sequence[str]],
    spoilt: Sequence[str],
    current: Fit,
    refused: Collection[str],
    least: float,
    seed: int,
) -> Exchanges:
    """Try to exchange the effect of each finding for each of its rivals, ids or formulas.

    Parameters
    ----------
    spoilt
        Effects that explain something beside the others, with values that cannot be right. One that
        makes an effect impossible, beside which they are, shows that it is not the cause.
    least
        The fall that a finding must bring.
    """

    def each(place: int) -> _Tried:
        finding = findings[place]
        held = [HOLDS[finding.effect]] if finding.effect in HOLDS else []
        several = dict.fromkeys((*held, *_wider(finding, current), *rivals[place]))
        free = [e for e in several if not _is_in(e, current)]
        allowed = [effect for effect in free if effect_name(effect) not in refused]
        possible = (*_simpler(finding), *allowed)
        return _tried(finding, possible, spoilt, current, least, seed)

    tried = on_each(each, range(len(findings)))
    made = [exchange for one in tried for exchange in one.exchanges]
    ties = {f.effect: one.ties for f, one in zip(findings, tried, strict=True) if one.ties}
    best = min(made, key=lambda one: held_out_square(one.by.fit, current), default=None)
    return Exchanges(best, ties)


@dataclass(frozen=True)
class _Tried:
    """The exchanges to be made of one effect, and the weights of those that predict as well."""

    exchanges: tuple[Exchange, ...] = ()
    ties: Mapping[str, float] = field(default_factory=dict)


def _tried(
    finding: Finding,
    possible: Sequence[str],
    spoilt: Sequence[str],
    current: Fit,
    least: float,
    seed: int,
) -> _Tried:
    """Try the exchange of one effect for others."""
    if not possible or (without := fit_without(current, finding, seed)) is None:
        return _Tried()
    made: list[Exchange] = []
    ties: dict[str, float] = {}
    for effect in possible[:MOST]:
        by = _in_place(finding, current, without, effect, seed)
        if by is None:
            continue
        present = Trial(finding.effect, current, by.evidence)
        worse, better = tie_statistic(by, present), tie_statistic(present, by)
        part = _simpler_in_place(by, finding, current, without, seed)
        judged = standing(without, by, (present, *part), least)
        if judged.refused:
            continue
        # What causes in the measurement explain as well may not come in by the back door.
        if judged.stand and _is_preferred(finding, by, current, worse, better):
            most = _most(finding, by, judged)
            made.append(Exchange(finding, without, by, worse, most))
        elif by.only_delays(finding.effect):
            continue
        elif better <= SIMPLEST and (by.parameters <= len(current.model.names) or worse > SIMPLEST):
            ties[by.effect] = tie_weight(better)
    return _Tried((*made, *_given_way(finding, without, spoilt, current, seed)), ties)


def _simpler(finding: Finding) -> tuple[str, ...]:
    """The effect that came with that of a finding: once others are added it may do alone."""
    return tuple(effect for effect in brought_by(finding) if effect != finding.effect)


def _wider(finding: Finding, current: Fit) -> list[str]:
    """Effects that contain another effect of the model: with that they may do alone."""
    others = {e for e in current.model.effects if e != finding.effect}
    return [effect for effect in effect_ids() if simpler_effect(effect) in others]


def _is_in(effect: str, current: Fit) -> bool:
    name, model = effect_name(effect), current.model
    return model.has(name) or name in (*model.own_effects, *model.rigid_body)


def _given_way(
    finding: Finding, without: Fit, spoilt: Sequence[str], current: Fit, seed: int
) -> list[Exchange]:
    """The exchange of an effect for the simpler one that it contains.

    It is made where the simpler one and an effect of `spoilt` together predict better: by two
    standard errors, or by one with no more parameters.
    """
    for simpler in _simpler(finding):
        found = screened(without, simpler, seed=seed)
        alone = None if found is None else try_effect(without, found)
        if alone is None:
            continue
        for effect in spoilt[:MOST]:
            both = screened(alone.fit, effect, seed=seed)
            trial = None if both is None else try_effect(alone.fit, both)
            if trial is None or trial.is_implausible or impossible(_claim(trial, alone.fit)):
                continue
            worse = difference(current, trial.fit).statistic
            if worse > _least_lead(trial, current):
                return [Exchange(finding, without, alone, worse)]
    return []


def _claim(trial: Trial, before: Fit) -> Claim:
    return Claim(trial.effect, before, trial.fit)


def _in_place(finding: Finding, current: Fit, without: Fit, effect: str, seed: int) -> Trial | None:
    """The trial of another effect in place of one; None where it cannot take its place."""
    whole = held_out_square(without, current)
    needed = 1.0 - (held_out_square(current, current) / whole) ** 0.5 if whole > 0.0 else 0.0
    found = screened(without, effect, seed=seed)
    if found is None or found.fall < PROMISE * needed:
        return None
    trial = try_effect(without, found)
    if trial is None or trial.is_implausible or trial.evidence.p_value > SIGNIFICANCE:
        return None
    claim = _claim(trial, without)
    return None if impossible(claim) or weak(claim) else trial


def _simpler_in_place(
    by: Trial, finding: Finding, current: Fit, without: Fit, seed: int
) -> tuple[Trial, ...]:
    """The trial, in place of an effect, of the simpler one that another brings; or nothing."""
    simpler = simpler_effect(by.effect)
    if simpler is None or simpler == finding.effect or without.model.has(simpler):
        return ()
    trial = _in_place(finding, current, without, simpler, seed)
    return () if trial is None else (trial,)


def _most(finding: Finding, by: Trial, judged: Sifted) -> float:
    """The highest confidence of an effect in place of another."""
    # What shows an effect that contains the other shows the other as well.
    most = judged.most.get(by.effect, 1.0)
    return min(most, NARROW) if simpler_effect(by.effect) == finding.effect else most


def _is_preferred(finding: Finding, by: Trial, current: Fit, worse: float, better: float) -> bool:
    """Whether the model with the other effect is the better one.

    It is where it predicts better by a standard error, or by two with more parameters. Where both
    predict alike, it is if its size is known and the other's is not, if it has fewer parameters, or
    if it has as many and is a rigid-body or measurement cause in place of friction. It is not where
    the present effect, of another form than its law, predicts better.
    """
    if _fits_in_another_form(finding, by, current):
        return False
    if worse > _least_lead(by, current):
        return True
    less_friction = is_friction(finding.effect) and not is_friction(by.effect)
    more_friction = is_friction(by.effect) and not is_friction(finding.effect)
    if better > SIMPLEST or more_friction:
        return False
    known, other_known = has_known_size(by.effect, by.fit), has_known_size(finding.effect, current)
    if known is not other_known:
        return known
    fewer = len(current.model.names) - by.parameters
    return fewer > 0 or (fewer == 0 and less_friction)


def _fits_in_another_form(finding: Finding, by: Trial, current: Fit) -> bool:
    """Whether a cause other than friction, in its free form, predicts better than one without."""
    if is_friction(finding.effect) or not columns_of(finding.effect, current):
        return False
    if columns_of(by.effect, by.fit):
        return False
    return free_difference(by.fit, current).statistic > TIE


def _least_lead(by: Trial, current: Fit) -> float:
    """Standard errors by which another model must predict better to be the better one."""
    return TIE if by.parameters > len(current.model.names) else SIMPLEST


def tied(finding: Finding, others: Mapping[str, float]) -> tuple[float, tuple[str, ...]]:
    """Weight and names of the ties of a finding once `others` predict as well."""
    new = {name: w for name, w in others.items() if name not in finding.indistinguishable_from}
    names = (*finding.indistinguishable_from, *new)
    return finding.weight / (1.0 + sum(new.values())), names


def ties_of(exchange: Exchange) -> dict[str, float]:
    """The effect that is replaced as a tie of the other, where both predict alike.

    An effect that contains the other is none: its further parameters bring nothing.
    """
    apart = exchange.apart
    if exchange.by.effect in _simpler(exchange.finding):
        return {}
    return {exchange.finding.effect: tie_weight(apart)} if apart <= TIE else {}
