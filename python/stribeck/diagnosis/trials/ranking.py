"""Findings in order: the best first, those indistinguishable from it next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from stribeck.base.pool import on_each
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.rules import DEMOTED, NotClaimed, impossible
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.beside_structure import ALIKE, is_undecided, structure_share
from stribeck.diagnosis.trials.evidence import difference, held_out_square
from stribeck.diagnosis.trials.known_size import has_known_size
from stribeck.diagnosis.trials.proxies import alike
from stribeck.diagnosis.trials.same_torque import only_imitates
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import (
    SIMPLEST,
    TIE,
    Trial,
    adds_to,
    falls_on_all_samples,
    passes,
    refined,
    tie_statistic,
    tie_weight,
)
from stribeck.effect.describe import is_friction, where
from stribeck.fitting.result import Fit
from stribeck.models.catalog import simpler_effect

#: A tie with a smaller weight changes no confidence that is shown.
NEGLIGIBLE = 0.005
#: An effect that explains less than this share of the squared error above the noise floor, and of
#: that in the band of the motion, is not reported, however significant: much larger causes remain.
MATERIAL = 0.05
OUTSIDE_THE_BAND = (
    "it lowers the error only at frequencies above those of the motion, where vibration and shocks "
    "raise it too"
)


@dataclass(frozen=True)
class Ranked:
    """Findings in order, those that are demoted, and effects that are not claimed."""

    findings: tuple[Finding, ...]
    demoted: tuple[Finding, ...]
    not_claimed: tuple[NotClaimed, ...]


def ranked(
    before: Fit, sift: Sifted, tried: int, least: float, floor: NoiseFloor, seed: int
) -> Ranked:
    """Order the trials that pass; of indistinguishable effects, the simplest first.

    Without findings where even the best explains hardly any of the unexplained error.
    """
    good = _simplest_first(before, sift)
    if not good:
        return _none_but_demoted(before, sift, tried, floor)
    best = good[0]
    statistic = {t.effect: tie_statistic(best, t) for t in good}
    tied = _tied(before, good, statistic, tried, least, seed)
    ordered = tied + [t for t in good if t not in tied]
    first = refined(ordered[0], before, seed)
    judged = Sifted.of(before, [first], least)
    confirmed = passes(first, tried, least) and falls_on_all_samples(before, first)
    if not (confirmed and judged.stand):
        # The thorough fit does not confirm the quick one.
        rest = sift.instead(first, judged if confirmed else Sifted())
        return ranked(before, rest, tried, least, floor, seed)
    # With a robust loss most of the unexplained error may be that of outliers.
    if before.loss_weight is None and not _is_material(before, first, floor):
        return _none_but_demoted(before, sift, tried, floor)
    ordered[0] = first
    weights = {t.effect: tie_weight(statistic[t.effect]) for t in good}
    # What is named as a tie is not excluded, however its error compares.
    weights.update({t.effect: max(weights[t.effect], tie_weight(TIE)) for t in tied})
    claimed = sum(weights[t.effect] for t in tied)
    doubtful = _doubtful_ties(before, best, sift, tried, least, floor, seed)
    total = claimed + sum(doubtful.values())
    alike = [t.effect for t in tied]
    named = [*alike, *(e for e, weight in doubtful.items() if weight >= tie_weight(TIE))]
    made = []
    for t in ordered:
        chance = min(1.0, t.evidence.p_value * tried)
        is_tied = t.effect in alike
        share = weights[t.effect] / (total if is_tied else total + weights[t.effect])
        others = tuple(o for o in named if o != t.effect) if is_tied else ()
        weight = float((1.0 - chance) * share)
        # Little remains for an effect whose simpler part is a tie, and measuring may cause that.
        if simpler_effect(t.effect) in others:
            weight = min(weight, DEMOTED)
        weight = min(weight, sift.most.get(t.effect, 1.0))
        made.append(finding_of(before, t, weight, others, floor))
    besides = _none_but_demoted(before, sift, tried, floor, best, claimed)
    return replace(besides, findings=tuple(made))


def _simplest_first(before: Fit, sift: Sifted) -> list[Trial]:
    """Trials from the best on, without it where a torque that it contains explains nearly as much.

    What a spring brings beyond its mean, an offset, is asked in the next step. So is what a lag
    within a sample brings beyond its Stribeck curve, which alone may be certain.
    """
    good = list(sift.stand)
    simpler = next((t for t in good[1:] if t.effect == simpler_effect(good[0].effect)), None)
    if simpler is None:
        return good
    if is_friction(good[0].effect):
        is_in_doubt = sift.most.get(good[0].effect, 1.0) <= DEMOTED
        return [simpler, *(t for t in good if t is not simpler)] if is_in_doubt else good
    level, best, other = (held_out_square(f, before) for f in (before, good[0].fit, simpler.fit))
    if level - other < ALIKE * (level - best):
        return good
    return [simpler, *(t for t in good[1:] if t is not simpler)]


def _none_but_demoted(
    before: Fit,
    sift: Sifted,
    tried: int,
    floor: NoiseFloor,
    best: Trial | None = None,
    total: float = 0.0,
) -> Ranked:
    """What the rules leave besides the findings that stand.

    Where none stands, also the trials that gain only outside the band of the motion.

    Parameters
    ----------
    best, total
        The best trial that stands, if one does, and the weights of those tied with it, summed.
    """
    made = []
    doubted = (*sift.demoted, *(_outside_the_band(before, sift) if best is None else ()))
    for trial, reason in ((row.trial, row.reason) for row in doubted):
        if not _is_material(before, trial, floor):
            continue
        weight = 1.0 if best is None else tie_weight(tie_statistic(best, trial))
        chance = min(1.0, trial.evidence.p_value * tried)
        most = min(DEMOTED, (1.0 - chance) * weight / (total + weight))
        made.append(replace(finding_of(before, trial, most, (), floor), demoted=reason))
    refused = tuple(NotClaimed(row.trial.effect, row.reason) for row in sift.refused)
    return Ranked((), tuple(made), refused)


def _outside_the_band(before: Fit, sift: Sifted) -> list[Doubted]:
    """Trials that gain only outside the band of the motion, with values that can be right."""
    return [
        Doubted(trial, OUTSIDE_THE_BAND)
        for trial in sift.rivals
        if impossible(Claim(trial.effect, before, trial.fit)) is None
    ]


def _is_material(before: Fit, trial: Trial, floor: NoiseFloor) -> bool:
    """Whether an effect explains much of the error, or of that in the band of the motion.

    Vibration may dominate the error outside that band.
    """
    taken = share_of_unexplained(before, trial.fit, floor)
    in_band = 1.0 - (1.0 - trial.evidence.fall_in_band) ** 2
    return taken is None or max(taken, in_band) >= MATERIAL


def _tied(
    before: Fit,
    good: list[Trial],
    statistic: dict[str, float],
    tried: int,
    least: float,
    seed: int,
) -> list[Trial]:
    """The best trial and those indistinguishable from it, in the order in which they are named."""
    best = good[0]
    level, least_left = held_out_square(before, before), held_out_square(best.fit, before)

    def is_alike(t: Trial) -> bool:
        """Whether it explains nearly as much, with no more parameters."""
        fall = level - held_out_square(t.fit, before)
        return fall >= ALIKE * (level - least_left) and t.parameters <= best.parameters

    near = [t for t in good[1:] if statistic[t.effect] <= TIE or is_alike(t)]
    adds = on_each(lambda t: adds_to(best, t, tried, least, seed), near)
    same = {t.effect for t, more in zip(near, adds, strict=True) if not more}
    tied = [best] + [t for t in good if t.effect in same]
    # Of the ties that may replace the best, the simplest of those with a known size comes first.
    may = on_each(lambda t: _may_replace(t, best, statistic[t.effect], tried, least, seed), tied)
    replaces = {t.effect: can for t, can in zip(tied, may, strict=True)}
    return sorted(
        tied,
        key=lambda t: (
            not replaces[t.effect],
            not has_known_size(t.effect, t.fit),
            t.parameters,
            t.rank,
        ),
    )


def _doubtful_ties(
    before: Fit,
    best: Trial,
    sift: Sifted,
    tried: int,
    least: float,
    floor: NoiseFloor,
    seed: int,
) -> dict[str, float]:
    """Weights of the effects that may not be claimed, and predict as well as the best that may.

    They are alternatives all the same: another cause, that the catalog does not hold, may have such
    a torque. So are those that gain only outside the band of the motion, such as the shocks of a
    backlash, which an elasticity imitates. Friction acts in the band: none of these replaces it.
    An effect with impossible values that has the very torque of the best is no alternative. Nor is
    one that delays the best by a few samples.
    """
    rivals = () if is_friction(best.effect) else sift.rivals
    refused = [row.trial for row in sift.refused if not only_imitates(row.trial, best, before)]
    demoted = [row.trial for row in sift.demoted if not row.trial.only_delays(best.effect)]
    trials = [*demoted, *refused, *rivals]
    left = structure_share(best.fit, floor)

    def weight(trial: Trial) -> float:
        effects, fits = (best.effect, trial.effect), (best.fit, trial.fit)
        if is_undecided(effects, fits, before, left):
            return 1.0
        return tie_weight(tie_statistic(best, trial))

    weights = {trial.effect: weight(trial) for trial in trials}
    alike = [trial for trial in trials if weights[trial.effect] > NEGLIGIBLE]
    adds = on_each(lambda trial: adds_to(best, trial, tried, least, seed), alike)
    apart = [trial.effect for trial, more in zip(alike, adds, strict=True) if more]
    return {t.effect: weights[t.effect] for t in alike if t.effect not in apart}


def finding_of(
    before: Fit, trial: Trial, weight: float, others: tuple[str, ...], floor: NoiseFloor
) -> Finding:
    """The finding that a trial is, indistinguishable from `others`."""
    names = alike(trial.effect, before, trial.fit)
    more = tuple(name for name in names if name not in others)
    # What no motion like this can tell apart is as likely, however its error compares.
    most = 1.0 / (1 + len(names))
    return Finding(
        effect=trial.effect,
        weight=min(weight / (1 + len(more)), most),
        certainty=difference(before, trial.fit).certainty,
        rmse_held_out_before=float(before.rmse_held_out or np.nan),
        rmse_held_out_after=float(trial.fit.rmse_held_out or np.nan),
        share_of_unexplained=share_of_unexplained(before, trial.fit, floor),
        where=where(trial.effect, before, trial.fit),
        indistinguishable_from=(*others, *more),
        fit=trial.fit,
        before=before,
    )


def _may_replace(
    trial: Trial, best: Trial, statistic: float, tried: int, least: float, seed: int
) -> bool:
    """Whether an effect may replace the best one.

    Its error must be within one standard error, or within two where the best one adds nothing to
    it. An effect that is not friction needs the former to replace one that is.
    """
    if trial is best or statistic <= SIMPLEST:
        return True
    if statistic > TIE or trial.parameters >= best.parameters:
        return False
    if is_friction(best.effect) and not is_friction(trial.effect):
        return False
    return not adds_to(trial, best, tried, least, seed)


class HeldOut(Protocol):
    """A fit, or another result with a held-out error."""

    @property
    def rmse_held_out(self) -> float | None:
        """Over the scored samples, in the unit of torque."""


def share_of_unexplained(before: HeldOut, after: HeldOut, floor: NoiseFloor) -> float | None:
    """(before^2 - after^2) / (before^2 - floor^2), clipped to 0..1."""
    if floor.value is None or before.rmse_held_out is None or after.rmse_held_out is None:
        return None
    room = before.rmse_held_out**2 - floor.value**2
    if room <= 0:
        return 0.0
    return float(np.clip((before.rmse_held_out**2 - after.rmse_held_out**2) / room, 0.0, 1.0))
