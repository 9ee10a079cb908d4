"""The loop, change by change: what is added, and what a later effect makes superfluous."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stribeck.base.errors import FitError
from stribeck.diagnosis.evidence import evidence
from stribeck.diagnosis.floor import NoiseFloor
from stribeck.diagnosis.ranking import share_of_unexplained
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.run import LEAST_FALL, diagnose
from stribeck.diagnosis.screen import STARTS
from stribeck.diagnosis.trial import SIGNIFICANCE, add_effect
from stribeck.effect.describe import where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.identify.search import QUICK

MOST_STEPS = 8


@dataclass(frozen=True)
class Step:
    """One accepted finding, and the model with it."""

    finding: Finding
    before: Fit
    after: Fit

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON of one step."""
        return {
            "effect": self.finding.effect,
            "confidence": self.finding.confidence,
            "rmse_before": self.before.rmse,
            "rmse_after": self.after.rmse,
            "rmse_held_out_before": self.before.rmse_held_out,
            "rmse_held_out_after": self.after.rmse_held_out,
            "share_of_unexplained": self.finding.share_of_unexplained,
            "where": self.finding.where,
            "indistinguishable_from": list(self.finding.indistinguishable_from),
            "parameters": {n: e.to_dict() for n, e in self.after.estimates.items()},
        }


@dataclass(frozen=True)
class Superfluous:
    """An effect that a later one has made superfluous, and the model it had been added to."""

    effect: str
    before: Fit
    because: str


@dataclass(frozen=True)
class Way:
    """How far the loop has come from `start`.

    Attributes
    ----------
    steps
        What was added, in order.
    superfluous
        What was added and then dropped; it is not tried again.
    last
        The last diagnosis: of `current`, or before the last change of the model before it.
    """

    start: Fit
    last: Diagnosis
    steps: tuple[Step, ...] = ()
    superfluous: tuple[Superfluous, ...] = ()

    @property
    def current(self) -> Fit:
        """The model that the way has led to."""
        return self.steps[-1].after if self.steps else self.start

    def with_best(self) -> Way:
        """One step on: the best finding of the last diagnosis added."""
        finding = self.last.findings[0]
        return replace(self, steps=(*self.steps, Step(finding, self.current, finding.fit)))

    def without(self, effect: str, seed: int) -> Way:
        """The same way without one effect: those after it are refitted in their turn."""
        place = next(k for k, step in enumerate(self.steps) if step.finding.effect == effect)
        dropped = self.steps[place]
        walked = list(self.steps[:place])
        current = dropped.before
        for step in self.steps[place + 1 :]:
            again = _refitted(step, current, self.last.noise_floor, seed)
            walked.append(again)
            current = again.after
        later = Superfluous(effect, dropped.before, self.steps[-1].finding.effect)
        return replace(self, steps=tuple(walked), superfluous=(*self.superfluous, later))


def walk(
    start: Fit,
    *,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    progress: Callable[[str], None] = lambda sentence: None,
) -> Iterator[Way]:
    """The loop, change by change: the way after each effect that is added or dropped.

    The last one ends where nothing passes the test, or after `most_steps`: its last diagnosis is
    that of its current model. Parameters are those of `improve`.
    """
    steps: tuple[Step, ...] = ()
    gone: tuple[Superfluous, ...] = ()
    while True:
        current = steps[-1].after if steps else start
        progress(f"looking for what {current.model.spec} misses")
        found = diagnose(
            current, least_fall=least_fall, rejected={*rejected, *(s.effect for s in gone)},
            candidates=candidates, seed=seed, sample_rows=start.recording.rows, brief=True,
        )  # fmt: skip
        way = Way(start, found, steps, gone)
        if not found.findings or len(steps) >= most_steps:
            yield way
            return
        progress(f"adding {found.findings[0].effect}")
        way = way.with_best()
        yield way
        shorter = _shortened(way, least_fall, seed, progress)
        if shorter is not None:
            way = shorter
            yield way
        steps, gone = way.steps, way.superfluous


def _refitted(step: Step, before: Fit, floor: NoiseFloor, seed: int) -> Step:
    """The same effect added to another model."""
    effect = step.finding.effect
    after = add_effect(before, step.after.model.written(effect), starts=STARTS, seed=seed)
    finding = replace(
        step.finding,
        rmse_held_out_before=float(before.rmse_held_out or np.nan),
        rmse_held_out_after=float(after.rmse_held_out or np.nan),
        share_of_unexplained=share_of_unexplained(before, after, floor),
        where=where(effect, before, after),
        fit=after,
        before=before,
    )
    return Step(finding, before, after)


def _shortened(
    way: Way, least_fall: float, seed: int, progress: Callable[[str], None]
) -> Way | None:
    """The way without an effect that is no longer needed; None where all are, or must stay."""
    idle = _superfluous(way.steps, least_fall, seed)
    if idle is None:
        return None
    progress(f"{idle} is no longer needed: walking the way again without it")
    try:
        return way.without(idle, seed)
    except FitError as error:
        # A bristle, say, whose dry friction only this effect keeps above zero.
        progress(f"{idle} stays: {error}")
        return None


def _superfluous(steps: tuple[Step, ...], least_fall: float, seed: int) -> str | None:
    """An earlier effect without which the model does as well, if there is one."""
    if len(steps) < 2:
        return None
    current = steps[-1].after
    for step in steps[:-1]:
        effect = step.finding.effect
        try:
            without = fit(
                current.model.without_effect(effect),
                current.recording,
                starts=1,
                seed=seed,
                transient=current.transient,
                effort=QUICK,
            )
        except FitError:
            continue
        rows = current.rows
        rise = rms(without.residual[rows]) / rms(current.residual[rows]) - 1.0
        if rise < least_fall / 2 or evidence(without, current).p_value > SIGNIFICANCE:
            return effect
    return None
