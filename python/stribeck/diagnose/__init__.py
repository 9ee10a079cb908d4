"""Which physical effect is missing from a model?"""

from __future__ import annotations

import os
from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import polars as pl

from stribeck.diagnose.floor import NoiseFloor, noise_floor
from stribeck.diagnose.screen import screened
from stribeck.diagnose.testable import Untestable, untestable
from stribeck.diagnose.trial import (
    SIGNIFICANCE,
    TIE,
    Trial,
    adds_to,
    explained_by_shape,
    passes,
    promises,
    refined,
    tie_statistic,
    tie_weight,
    try_beyond,
    try_effect,
)
from stribeck.diagnose.unexplained import Unexplained, unexplained
from stribeck.diagnose.visibility import Group, SmallestVisible, visibility
from stribeck.diagnose.words import where
from stribeck.fit import Fit, on_recording, own_load
from stribeck.formula_law import effect_name
from stribeck.identify.scaling import check_channels
from stribeck.model import Model, catalog, effect_ids
from stribeck.recording import Recording

#: Least relative fall of the held-out RMSE that a finding must bring.
LEAST_FALL = 0.01
#: An effect that brings this share of the best one's fall, and nothing beside it, is its like.
ALIKE = 0.9


@dataclass(frozen=True)
class Finding:
    """An effect that passed the test."""

    effect: str
    confidence: float
    rmse_held_out_before: float
    rmse_held_out_after: float
    share_of_unexplained: float | None
    where: str
    indistinguishable_from: tuple[str, ...]
    fit: Fit

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON."""
        return {
            "effect": self.effect,
            "confidence": self.confidence,
            "rmse_held_out_before": self.rmse_held_out_before,
            "rmse_held_out_after": self.rmse_held_out_after,
            "share_of_unexplained": self.share_of_unexplained,
            "where": self.where,
            "indistinguishable_from": list(self.indistinguishable_from),
        }


@dataclass(frozen=True)
class Diagnosis:
    """What is missing from a model on a recording.

    Attributes
    ----------
    verdict : {"missing", "none", "unexplained"}
    findings
        Effects that pass the test, best first.
    smallest_visible
        For each effect that was tried and not found, the smallest that would have been.
    groups
        Effects that this recording cannot tell apart.
    """

    fit: Fit
    noise_floor: NoiseFloor
    verdict: str
    findings: tuple[Finding, ...]
    untestable: tuple[Untestable, ...]
    unexplained: Unexplained
    smallest_visible: tuple[SmallestVisible, ...] = ()
    groups: tuple[Group, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON of `stribeck diagnose`."""
        made: dict[str, Any] = {
            "model": self.fit.model.spec,
            "rmse": self.fit.rmse,
            "rmse_held_out": self.fit.rmse_held_out,
            "unit": self.fit.model.torque_unit,
            "noise_floor": self.noise_floor.value,
            "verdict": self.verdict,
            "findings": [finding.to_dict() for finding in self.findings],
            "untestable": [row.to_dict() for row in self.untestable],
            "unexplained": self.unexplained.to_dict(),
            "smallest_visible": [row.to_dict() for row in self.smallest_visible],
            "indistinguishable_groups": [list(group.effects) for group in self.groups],
            "indistinguishable": [group.to_dict() for group in self.groups],
            "scored": self.fit.recording.scored(),
            "notes": [*self.fit.recording.notes, *self.fit.notes],
        }
        if self.noise_floor.value is None:
            made["noise_floor_why"] = self.noise_floor.why
        return made

    def to_frame(self) -> pl.DataFrame:
        """The findings as a table."""
        return pl.DataFrame([finding.to_dict() for finding in self.findings])

    def plot(self) -> Any:
        """Residual against each channel, before the first finding and after."""
        from stribeck.report.figures import residual_figure

        after = [self.findings[0].fit] if self.findings else []
        return residual_figure([self.fit, *after])

    def __repr__(self) -> str:
        from stribeck.report.text import diagnosis_text

        return diagnosis_text(self)

    def _repr_html_(self) -> str:
        return f"<pre>{self!r}</pre>"


def diagnose(
    fitted: Fit,
    recording: Recording | None = None,
    *,
    least_fall: float = LEAST_FALL,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    seed: int = 0,
) -> Diagnosis:
    """Find the effects that are missing from `fitted`.

    Every effect that the recording can show is added and refitted. It passes if the held-out
    error falls by at least `least_fall`, if that is more than chance given the residual's
    autocorrelation and the number of effects tried, and if the effects already in the model
    cannot do the same by taking a freer form.

    Parameters
    ----------
    recording : Recording
        Default: the fit's own. On another one the model is fitted again first.
    rejected : collection of str
        Effects that are not to be tried.
    candidates : collection of str
        Effects by formula that are to be tried too: ``"creep = c*abs(load)*sgn(v)"``.
    """
    fitted = on_recording(fitted, recording, seed)
    recording, model = fitted.recording, fitted.model
    cannot = untestable(recording, own_load(model, recording))
    inside = set(model.effects) | set(model.rigid_body)
    inside.update(model.own_effects)
    for effect in candidates:
        if effect_name(effect) not in inside:
            check_channels(model.with_effect(effect, {}), recording)
    possible = [
        effect
        for effect in (*effect_ids(), *candidates)
        if not {effect_name(effect)} & {*inside, *cannot, *rejected}
    ]
    alone = [e for e in possible if _contained(e, model) is None]
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        looked_at = [s for s in pool.map(partial(screened, fitted, seed=seed), alone) if s]
        promising = [s for s in looked_at if promises(s, least_fall)]
        trials = [t for t in pool.map(partial(try_effect, fitted), promising) if t]
    tried = max(len(looked_at), 1)
    for effect in possible:
        simpler = next((t for t in trials if t.effect == _contained(effect, model)), None)
        if simpler is not None and passes(simpler, tried, least_fall):
            beyond = try_beyond(simpler, effect, fitted, least_fall, seed=seed)
            if beyond is not None and passes(beyond[0], tried, least_fall):
                trials.append(beyond[1])
    good = [
        t
        for t in trials
        if passes(t, tried, least_fall)
        and _reported_fall(fitted, t)
        and not explained_by_shape(fitted, t, tried, least_fall)
    ]
    good.sort(key=lambda t: t.rank)
    best_fit = good[0].fit if good else fitted
    floor = noise_floor(best_fit)
    findings = _findings(fitted, good, tried, least_fall, floor, seed)
    left = unexplained(best_fit if good else fitted, floor)
    verdict = "missing" if findings else ("unexplained" if left.is_structure else "none")
    shown = tuple(row for effect, row in cannot.items() if effect not in inside)
    found = {e for f in findings for e in (f.effect, *f.indistinguishable_from)}
    could = visibility(
        fitted, [e for e in possible if e in effect_ids()], found=found, tried=tried,
        significance=SIGNIFICANCE, least_fall=least_fall,
    )  # fmt: skip
    return Diagnosis(
        fitted, floor, verdict, findings, (*shown, *could.hidden), left,
        could.smallest, could.groups,
    )  # fmt: skip


def _contained(effect: str, model: Model) -> str | None:
    """The simpler effect that `effect` contains and `model` lacks, if there is one."""
    simpler: str | None = catalog()["effects"].get(effect, {}).get("beyond")
    return None if simpler is None or model.has(simpler) else simpler


def _reported_fall(before: Fit, trial: Trial) -> bool:
    """The error over all scored rows must fall too, transients included."""
    assert before.rmse_held_out is not None and trial.fit.rmse_held_out is not None
    return trial.fit.rmse_held_out < before.rmse_held_out


def _findings(
    before: Fit, good: list[Trial], tried: int, least: float, floor: NoiseFloor, seed: int
) -> tuple[Finding, ...]:
    """Order the trials that pass; effects that are one on this data, the simplest first."""
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
    # Of those within the standard error the simplest comes first.
    tied.sort(key=lambda t: (statistic[t.effect] > TIE, t.parameters, t.rank))
    ordered = tied + [t for t in good if t not in tied]
    first = refined(ordered[0], before, seed)
    if not (passes(first, tried, least) and _reported_fall(before, first)):
        # What a quick fit promised does not stand up to a thorough one.
        rest = [t for t in good if t.effect != first.effect]
        return _findings(before, rest, tried, least, floor, seed)
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
            )
        )
    return tuple(made)


def share_of_unexplained(before: Fit, after: Fit, floor: NoiseFloor) -> float | None:
    """(before^2 - after^2) / (before^2 - floor^2), clipped to 0..1."""
    if floor.value is None or before.rmse_held_out is None or after.rmse_held_out is None:
        return None
    room = before.rmse_held_out**2 - floor.value**2
    if room <= 0:
        return 0.0
    return float(np.clip((before.rmse_held_out**2 - after.rmse_held_out**2) / room, 0.0, 1.0))


__all__ = [
    "LEAST_FALL",
    "Diagnosis",
    "Finding",
    "Group",
    "NoiseFloor",
    "SmallestVisible",
    "Unexplained",
    "Untestable",
    "diagnose",
    "share_of_unexplained",
    "untestable",
]
