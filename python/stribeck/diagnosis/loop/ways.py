"""Several beginnings: where the first step is in doubt, the loop goes on from other effects too.

Causes share shapes: beside the wrong one the right ones may explain too little to be found. The
models at the end of each way are compared, as those of an exchange are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy

from stribeck.diagnosis.loop.path import Dropped, ImprovementPath
from stribeck.diagnosis.loop.provisional import judged
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.evidence import difference, gain_by_block, held_out_square
from stribeck.diagnosis.trials.flexible_refit import free_difference
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.ranking import finding_of
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.trial import SIMPLEST, TIE, tie_weight, try_effect
from stribeck.effect.describe import is_friction
from stribeck.fitting.result import Fit
from stribeck.models.catalog import simpler_effect
from stribeck.models.formula_law import effect_name

#: A first effect of at least this weight is not in doubt.
FIRM = 0.9
#: Other beginnings that are tried.
OTHERS = 2
#: Share of what the first effect explains that a rival explains, beside which it is in doubt.
RIVAL = 0.75


def other_beginnings(start: Diagnosis, path: ImprovementPath, seed: int) -> Iterator[Finding]:
    """What the loop may begin with instead, likeliest first; nothing where the first is firm.

    Also effects that explain nearly as much as the first alone: beside others they may explain
    more. Where structure remains at the end of `path`, also effects that lower the error, but may
    not be claimed alone. Of one that contains a simpler effect, that.
    """
    doubtful = _is_doubtful(path)
    firm = not start.findings or start.findings[0].weight >= FIRM
    likely = [] if firm else sorted(start.findings[1:], key=lambda found: -found.weight)[:OTHERS]
    yield from likely
    count = len(likely)
    tried = {found.effect for found in (*start.findings[:1], *likely)}
    for name in dict.fromkeys(simpler_effect(effect) or effect for effect in start.passed):
        if count == OTHERS:
            return
        began = None if effect_name(name) in tried else _begun(start, name, seed)
        if began is not None and (doubtful or _is_rival(began, start)):
            yield began
            count += 1


def _is_doubtful(path: ImprovementPath) -> bool:
    """Whether structure remains, and what was found first is not firm."""
    remains = path.last.unexplained.is_structure or path.last.noise_floor.value is None
    return remains and (not path.steps or path.steps[0].finding.confidence < FIRM)


def _is_rival(other: Finding, start: Diagnosis) -> bool:
    """Whether an effect explains nearly as much alone as the first, which is no friction."""
    first = start.findings[0] if start.findings else None
    if first is None or is_friction(first.effect):
        return False
    explained = held_out_square(start.fit, start.fit) - held_out_square(first.fit, start.fit)
    by_other = held_out_square(start.fit, start.fit) - held_out_square(other.fit, start.fit)
    return by_other >= RIVAL * explained


def _begun(start: Diagnosis, effect: str, seed: int) -> Finding | None:
    """An effect as the first, without a weight of its own; None where it cannot be fitted."""
    found = screened(start.fit, effect, seed=seed)
    trial = None if found is None else try_effect(start.fit, found)
    return None if trial is None else finding_of(start.fit, trial, 0.0, (), start.noise_floor)


def best_of(ways: Sequence[ImprovementPath], least: float, seed: int) -> ImprovementPath:
    """The way whose last model predicts best, the first of those that predict alike.

    The effect with which another way than the first begins must pass all tests at its end. It is as
    certain as the models of the others predict worse. Where the first effect is firm, a way that
    holds it too is none: from there the first way has found nothing else.
    """
    best = ways[0]
    firm = [step.finding.effect for step in best.steps[:1] if step.finding.weight >= FIRM]
    for way in ways[1:]:
        if not way.steps or any(map(way.holding, firm)) or not _is_better(way, best):
            continue
        began = judged(way.steps[0].finding, way.current, least, seed)
        if began is not None:
            best = way.with_instead(began)
    if best is ways[0]:
        return best
    others = [way for way in ways if not _ends_alike(way, best)]
    rival = sum(tie_weight(difference(o.current, best.current).statistic) for o in others)
    first = best.steps[0].finding
    weight = min(NARROW, 1.0 / (1.0 + rival))
    best = best.with_instead(replace(first, weight=weight, indistinguishable_from=()))
    left = [step.finding.effect for step in ways[0].steps[:1]]
    reason = f"the model found when {first.effect} is added first predicts better without it"
    gone = [Dropped(e, best.start, reason) for e in left if best.holding(e) is None]
    return replace(best, dropped=(*best.dropped, *gone))


def predicts_better(model: Fit, other: Fit) -> bool:
    """Whether the held-out error of a model is smaller, by more than chance explains.

    It is smaller by more than two standard errors, or in so many blocks. An error that is large in
    one block makes the standard error as large.
    """
    found = difference(other, model)
    return found.statistic > TIE or (found.total > 0.0 and _in_most_blocks(model, other))


def _in_most_blocks(model: Fit, other: Fit) -> bool:
    """Whether a model predicts more blocks better than chance does, as rarely as beyond `TIE`."""
    gain = gain_by_block(other, model)
    better = int(np.sum(gain > 0.0))
    chance = scipy.stats.binom.sf(better - 1, np.count_nonzero(gain), 0.5)
    return bool(chance < scipy.stats.norm.sf(TIE))


def _is_better(way: ImprovementPath, than: ImprovementPath) -> bool:
    """Whether a way ends better: by two standard errors, or by none with fewer parameters.

    Several causes stand in for one whose torque has another form than its law. A way with fewer
    effects than another, no more of them friction, is therefore compared in free forms too: it is
    better where it predicts better in these, and worse only if it does not.
    """
    if predicts_better(way.current, than.current):
        return not _is_smaller(than, way) or _predicts_better_in_free_forms(way, than)
    if _is_smaller(way, than) and _predicts_better_in_free_forms(way, than):
        return True
    fewer = len(way.current.model.names) < len(than.current.model.names)
    return fewer and difference(way.current, than.current).statistic <= SIMPLEST


def _predicts_better_in_free_forms(way: ImprovementPath, than: ImprovementPath) -> bool:
    return free_difference(than.current, way.current).statistic > TIE


def _is_smaller(way: ImprovementPath, than: ImprovementPath) -> bool:
    """Whether a way has fewer effects, and no more of them are friction."""
    few, many = way.current.model.effects, than.current.model.effects
    return len(few) < len(many) and sum(map(is_friction, few)) <= sum(map(is_friction, many))


def _ends_alike(way: ImprovementPath, other: ImprovementPath) -> bool:
    """Whether two ways end with the same effects."""
    return set(way.current.model.effects) == set(other.current.model.effects)
