"""Findings in order: the best first, and those that are one on this data together."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from stribeck.diagnosis.floor import NoiseFloor
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trial import (
    SIMPLEST,
    TIE,
    Trial,
    adds_to,
    passes,
    refined,
    reported_fall,
    tie_statistic,
    tie_weight,
)
from stribeck.effect.describe import is_friction, where
from stribeck.fitting.result import Fit

#: An effect that brings this share of the best one's fall, and nothing beside it, is its like.
ALIKE = 0.9
#: An effect that takes less than this share of the squared error above the noise floor is not what
#: is missing, however certain: much larger causes are left.
MATERIAL = 0.05


def findings(
    before: Fit, good: list[Trial], tried: int, least: float, floor: NoiseFloor, seed: int
) -> tuple[Finding, ...]:
    """Order the trials that pass; effects that are one on this data, the simplest first.

    None where even the best takes hardly any of what is missing.
    """
    if not good:
        return ()
    best = good[0]
    statistic = {t.effect: tie_statistic(best, t) for t in good}
    level = float(np.sum(before.held_out_residual[before.rows] ** 2))
    same = {
        t.effect
        for t in good[1:]
        if (statistic[t.effect] <= TIE or level - t.square >= ALIKE * (level - best.square))
        and not adds_to(best, t, tried, least, seed)
    }
    tied = [best] + [t for t in good if t.effect in same]
    # The simplest comes first of those that serve as well as the best.
    serves = {t.effect: _serves(t, best, statistic[t.effect], tried, least, seed) for t in tied}
    tied.sort(key=lambda t: (not serves[t.effect], t.parameters, t.rank))
    ordered = tied + [t for t in good if t not in tied]
    first = refined(ordered[0], before, seed)
    if not (passes(first, tried, least) and reported_fall(before, first)):
        # What a quick fit promised does not stand up to a thorough one.
        rest = [t for t in good if t.effect != first.effect]
        return findings(before, rest, tried, least, floor, seed)
    taken = share_of_unexplained(before, first.fit, floor)
    if taken is not None and taken < MATERIAL:
        return ()
    ordered[0] = first
    alike = [t.effect for t in tied]
    weights = {t.effect: tie_weight(statistic[t.effect]) for t in good}
    total = sum(weights[effect] for effect in alike)
    made = []
    for t in ordered:
        chance = min(1.0, t.evidence.p_value * tried)
        share = weights[t.effect] / (total if t.effect in alike else total + weights[t.effect])
        others = tuple(o for o in alike if o != t.effect) if t.effect in alike else ()
        made.append(
            Finding(
                effect=t.effect,
                confidence=float((1.0 - chance) * share),
                rmse_held_out_before=float(before.rmse_held_out or np.nan),
                rmse_held_out_after=float(t.fit.rmse_held_out or np.nan),
                share_of_unexplained=share_of_unexplained(before, t.fit, floor),
                where=where(t.effect, before, t.fit),
                indistinguishable_from=others,
                fit=t.fit,
                before=before,
            )
        )
    return tuple(made)


def _serves(
    trial: Trial, best: Trial, statistic: float, tried: int, least: float, seed: int
) -> bool:
    """Whether an effect may stand for the best one.

    Within a standard error of it; or within two, where the best adds nothing beside it. A cause
    outside the friction needs the former to stand for friction, which is known to vary.
    """
    if trial is best or statistic <= SIMPLEST:
        return True
    if statistic > TIE or trial.parameters >= best.parameters:
        return False
    if is_friction(best.effect) and not is_friction(trial.effect):
        return False
    return not adds_to(trial, best, tried, least, seed)


class HeldOut(Protocol):
    """Whatever has a held-out error."""

    @property
    def rmse_held_out(self) -> float | None:
        """Over the scored rows, in the unit of torque."""


def share_of_unexplained(before: HeldOut, after: HeldOut, floor: NoiseFloor) -> float | None:
    """(before^2 - after^2) / (before^2 - floor^2), clipped to 0..1."""
    if floor.value is None or before.rmse_held_out is None or after.rmse_held_out is None:
        return None
    room = before.rmse_held_out**2 - floor.value**2
    if room <= 0:
        return 0.0
    return float(np.clip((before.rmse_held_out**2 - after.rmse_held_out**2) / room, 0.0, 1.0))
