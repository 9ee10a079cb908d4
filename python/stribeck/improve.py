"""Diagnose and add until what is left is noise."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import polars as pl

from stribeck.diagnose import (
    LEAST_FALL,
    Diagnosis,
    Finding,
    NoiseFloor,
    Unexplained,
    Untestable,
    diagnose,
    share_of_unexplained,
)
from stribeck.diagnose.evidence import evidence
from stribeck.diagnose.screen import STARTS
from stribeck.diagnose.trial import SIGNIFICANCE, add_effect
from stribeck.diagnose.words import where
from stribeck.fit import Fit, fit, on_recording
from stribeck.formula_law import is_formula
from stribeck.identify.figures import rms
from stribeck.model import Model, check_effect
from stribeck.recording import Recording

MOST_STEPS = 8


@dataclass(frozen=True)
class Addition:
    """One effect added: the model before and after, on the same rows."""

    effect: str
    before: Fit
    after: Fit

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON of `stribeck add`."""
        return {
            "model": self.after.model.spec,
            "effect": self.effect,
            "rmse_before": self.before.rmse,
            "rmse_after": self.after.rmse,
            "rmse_held_out_before": self.before.rmse_held_out,
            "rmse_held_out_after": self.after.rmse_held_out,
            "unit": self.after.model.torque_unit,
            "parameters": {n: e.to_dict() for n, e in self.after.estimates.items()},
            "scored": self.after.recording.scored(),
        }

    def __repr__(self) -> str:
        from stribeck.report.text import addition_text

        return addition_text(self.before, self.after, self.effect)


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
class Improvement:
    """The way from a base model to one that leaves noise."""

    base: Fit
    steps: tuple[Step, ...]
    final: Fit
    noise_floor: NoiseFloor
    stopped: str
    untestable: tuple[Untestable, ...]
    unexplained: Unexplained
    last: Diagnosis

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON of `stribeck improve`."""
        made: dict[str, Any] = {
            "base": self.base.model.spec,
            "unit": self.final.model.torque_unit,
            "noise_floor": self.noise_floor.value,
            "steps": [step.to_dict() for step in self.steps],
            "final": {
                "model": self.final.model.spec,
                "rmse": self.final.rmse,
                "rmse_held_out": self.final.rmse_held_out,
                "relative_residual": self.final.relative_residual,
                "parameters": {n: e.to_dict() for n, e in self.final.estimates.items()},
            },
            "rmse_held_out_base": self.base.rmse_held_out,
            "relative_residual_base": self.base.relative_residual,
            "stopped": self.stopped,
            "untestable": [row.to_dict() for row in self.untestable],
            "unexplained": self.unexplained.to_dict(),
            "explainable": self.last.explainable.to_dict() if self.last.explainable else None,
            "smallest_visible": [row.to_dict() for row in self.last.smallest_visible],
            "indistinguishable": [group.to_dict() for group in self.last.groups],
            "scored": self.final.recording.scored(),
            "notes": [*self.final.recording.notes, *self.final.notes],
        }
        if self.noise_floor.value is None:
            made["noise_floor_why"] = self.noise_floor.why
        return made

    def to_frame(self) -> pl.DataFrame:
        """One row a step."""
        rows = [{"effect": "(base)", "model": self.base.model.spec, "rmse": self.base.rmse,
                 "rmse_held_out": self.base.rmse_held_out}]  # fmt: skip
        rows += [{"effect": s.finding.effect, "model": s.after.model.spec, "rmse": s.after.rmse,
                  "rmse_held_out": s.after.rmse_held_out} for s in self.steps]  # fmt: skip
        return pl.DataFrame(rows)

    def plot(self) -> Any:
        """Measured and modelled torque and the residual, before and after."""
        from stribeck.report.figures import improvement_figure

        return improvement_figure(self)

    def __repr__(self) -> str:
        from stribeck.report.text import improvement_text

        return improvement_text(self)

    def _repr_html_(self) -> str:
        return f"<pre>{self!r}</pre>"


def add(
    fitted: Fit, effect: str, recording: Recording | None = None, *, starts: int = 20, seed: int = 0
) -> Fit:
    """Add `effect` to a fitted model and refit it on `recording` (default: the fit's own).

    Parameters
    ----------
    effect : str
        An id of the catalog, or an effect by formula: ``"creep = c*abs(load)*sgn(v)"``.

    Raises
    ------
    SpecError
        The effect is unknown or in the model already.
    FitError
        The recording lacks a channel that the effect needs.
    """
    if not is_formula(effect):
        check_effect(effect)
    return add_effect(on_recording(fitted, recording, seed), effect, starts=starts, seed=seed)


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
            candidates=candidates, seed=seed, brief=True,
        )  # fmt: skip
        way = Way(start, found, steps, gone)
        if not found.findings or len(steps) >= most_steps:
            yield way
            return
        progress(f"adding {found.findings[0].effect}")
        way = way.with_best()
        yield way
        idle = _superfluous(way.steps, least_fall, seed)
        if idle is not None:
            progress(f"{idle} is no longer needed: walking the way again without it")
            way = way.without(idle, seed)
            yield way
        steps, gone = way.steps, way.superfluous


def improve(
    base: str | Model,
    recording: Recording,
    *,
    starts: int = 20,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    progress: Callable[[str], None] = lambda sentence: None,
) -> Improvement:
    """Diagnose and add until nothing passes the test.

    An effect that a later one makes superfluous is dropped; the others are fitted again in
    their turn.

    Parameters
    ----------
    rejected, candidates : collections of str
        Effects that are never added, and effects by formula that are tried too
        (``"creep = c*abs(load)*sgn(v)"``).
    progress : callable
        Told what is being done, in one sentence.
    """
    progress(f"fitting {base if isinstance(base, str) else base.spec}")
    first = fit(base, recording, starts=starts, seed=seed)
    *_, way = walk(
        first, seed=seed, least_fall=least_fall, most_steps=most_steps, rejected=rejected,
        candidates=candidates, progress=progress,
    )  # fmt: skip
    found = way.last
    stopped = "nothing_passes"
    if found.findings:
        stopped = "max_steps"
    elif found.noise_floor.value is not None and not found.unexplained.is_structure:
        stopped = "noise_floor"
    return Improvement(
        first, way.steps, way.current, found.noise_floor, stopped, found.untestable,
        found.unexplained, found,
    )  # fmt: skip


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


def _superfluous(steps: tuple[Step, ...], least_fall: float, seed: int) -> str | None:
    """An earlier effect without which the model does as well, if there is one."""
    if len(steps) < 2:
        return None
    current = steps[-1].after
    for step in steps[:-1]:
        effect = step.finding.effect
        without = fit(
            current.model.without_effect(effect),
            current.recording,
            starts=1,
            seed=seed,
            transient=current.transient,
        )
        rows = current.rows
        rise = rms(without.residual[rows]) / rms(current.residual[rows]) - 1.0
        if rise < least_fall / 2 or evidence(without, current).p_value > SIGNIFICANCE:
            return effect
    return None
