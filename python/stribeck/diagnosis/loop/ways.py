"""Several beginnings: where the first step is in doubt, the loop goes on from other effects too.

Causes share shapes: beside the wrong one the right ones may explain too little to be found. The
models at the end of each way are compared, as those of an exchange are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stribeck.diagnosis.loop.path import Dropped, ImprovementPath
from stribeck.diagnosis.loop.provisional import judged
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.evidence import difference
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.trial import SIMPLEST, TIE, tie_weight

#: A first effect of at least this weight is not in doubt.
FIRM = 0.9
#: Other beginnings that are tried.
OTHERS = 2


def other_beginnings(found: Diagnosis) -> list[Finding]:
    """What the loop may begin with instead, likeliest first; nothing where the first is firm."""
    if not found.findings or found.findings[0].weight >= FIRM:
        return []
    return sorted(found.findings[1:], key=lambda finding: -finding.weight)[:OTHERS]


def best_of(ways: Sequence[ImprovementPath]) -> ImprovementPath:
    """The way whose last model predicts best, the first of those that predict alike.

    The effect with which it begins is as certain as the models of the others predict worse.
    """
    best = ways[0]
    for way in ways[1:]:
        if _is_better(way, best):
            best = way
    if best is ways[0] or not best.steps:
        return best
    begun = ways[0].steps[0].finding.effect
    others = [way for way in ways if not _holds_all(way, best)]
    rival = sum(tie_weight(difference(o.current, best.current).statistic) for o in others)
    began = best.steps[0].finding
    first = replace(began, weight=min(NARROW, 1.0 / (1.0 + rival)), indistinguishable_from=())
    best = best.with_instead(first)
    if best.holding(begun) is not None:
        return best
    reason = f"the model found when {first.effect} is added first predicts better without it"
    return replace(best, dropped=(*best.dropped, Dropped(begun, best.start, reason)))


def _is_better(way: ImprovementPath, than: ImprovementPath) -> bool:
    """Whether a way ends better: by two standard errors, or by none with fewer parameters."""
    fewer = len(way.current.model.names) < len(than.current.model.names)
    if difference(than.current, way.current).statistic > TIE:
        return True
    return fewer and difference(way.current, than.current).statistic <= SIMPLEST


def _holds_all(way: ImprovementPath, other: ImprovementPath) -> bool:
    """Whether two ways end with the same effects."""
    return set(way.current.model.effects) == set(other.current.model.effects)


def settled(path: ImprovementPath, least: float, seed: int) -> ImprovementPath:
    """The path without ties of an effect with others that are all in the model too.

    The effect must pass all tests there, beside them, and is no surer than one that stands by
    little.
    """
    inside = {step.finding.effect for step in path.steps}
    for finding in (step.finding for step in path.steps):
        ties = finding.indistinguishable_from
        if not ties or not inside.issuperset(ties):
            continue
        stands = judged(finding, path.current, least, seed)
        if stands is not None:
            path = path.with_instead(replace(stands, indistinguishable_from=()))
    return path
