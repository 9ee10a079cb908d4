"""Diagnose and add until what is left is noise."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from typing import Any

import polars as pl

from stribeck.base.pool import on_threads
from stribeck.base.shown import Plotted, Shown
from stribeck.diagnosis.floor import NoiseFloor
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.run import LEAST_FALL
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.trial import add_effect
from stribeck.diagnosis.unexplained import Unexplained
from stribeck.diagnosis.walk import MOST_STEPS, Step, Way, walk
from stribeck.diagnosis.whole import NEAR, noted, on_all_rows, recounted
from stribeck.fitting.fit import fit, on_recording
from stribeck.fitting.result import Fit
from stribeck.identify.transients import transient_rows
from stribeck.models.catalog import check_effect
from stribeck.models.formula_law import is_formula
from stribeck.models.model import Model
from stribeck.recording.excerpt import SAMPLE_ROWS, excerpt
from stribeck.recording.recording import Recording


@dataclass(frozen=True, repr=False)
class Addition(Shown):
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


@dataclass(frozen=True, repr=False)
class Improvement(Plotted):
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
    sample_rows: int = SAMPLE_ROWS,
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
    sample_rows : int
        In a longer recording causes are looked for on so many rows, in stretches taken evenly; each
        step's model is then identified on all rows.
    progress : callable
        Told what is being done, in one sentence.
    """
    progress(f"fitting {base if isinstance(base, str) else base.spec}")
    few = excerpt(recording, sample_rows, seed)
    first = fit(base, few, starts=starts, seed=seed)
    *_, way = walk(
        first, seed=seed, least_fall=least_fall, most_steps=most_steps, rejected=rejected,
        candidates=candidates, progress=progress,
    )  # fmt: skip
    if few is not recording:
        way = _on_all_rows(way, recording, progress)
    found = way.last
    stopped = "nothing_passes"
    if found.findings:
        stopped = "max_steps"
    elif not found.unexplained.is_structure and found.noise_floor.is_reached_by(way.current.rmse):
        stopped = "noise_floor"
    return Improvement(
        way.start, way.steps, way.current, found.noise_floor, stopped, found.untestable,
        found.unexplained, found,
    )  # fmt: skip


def _on_all_rows(way: Way, recording: Recording, progress: Callable[[str], None]) -> Way:
    """The same way with each model identified on all rows of `recording`."""
    progress(f"identifying the models on all {recording.rows} rows")
    transient = transient_rows(recording)
    rows = way.start.recording.rows
    *on_the_way, last = [way.start, *(step.after for step in way.steps)]
    with on_threads() as pool:
        longest = pool.submit(on_all_rows, last, recording, transient, NEAR)
        # Of the models on the way only the errors are wanted.
        fits = list(pool.map(lambda found: on_all_rows(found, recording, transient), on_the_way))
        fits.append(noted(longest.result(), rows))
    steps = [
        Step(recounted(step.finding, before, after, way.last.noise_floor), before, after)
        for step, (before, after) in zip(way.steps, itertools.pairwise(fits), strict=True)
    ]
    return replace(way, start=fits[0], steps=tuple(steps))
