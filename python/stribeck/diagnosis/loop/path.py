"""The greedy loop: the best effect is added at each step, and superfluous ones are dropped."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace

import numpy as np

from stribeck.base.errors import FitError
from stribeck.diagnosis.diagnose import LEAST_FALL, diagnose
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.diagnosis.trials.screening import STARTS
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, add_effect
from stribeck.effect.describe import where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.effort import QUICK
from stribeck.identify.figures import rms

MOST_STEPS = 8


@dataclass(frozen=True)
class ImprovementStep:
    """One accepted finding, and the model with it."""

    finding: Finding
    before: Fit
    after: Fit

    def to_dict(self) -> dict[str, object]:
        """The JSON of one step."""
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
            **self.finding.support(),
            "parameters": {n: e.to_dict() for n, e in self.after.estimates.items()},
        }


@dataclass(frozen=True)
class Superfluous:
    """An effect that a later one has made superfluous, and the model it had been added to."""

    effect: str
    before: Fit
    because: str


@dataclass(frozen=True)
class ImprovementPath:
    """The state of the loop: what it has added to `start` so far.

    Attributes
    ----------
    steps
        What was added, in order.
    superfluous
        What was added and then dropped; these effects are not tried again.
    last
        The last diagnosis: of `current`, or of the model before the last change.
    """

    start: Fit
    last: Diagnosis
    steps: tuple[ImprovementStep, ...] = ()
    superfluous: tuple[Superfluous, ...] = ()

    @property
    def current(self) -> Fit:
        """The model at the end of the path."""
        return self.steps[-1].after if self.steps else self.start

    def with_best(self) -> ImprovementPath:
        """The path with the best finding of the last diagnosis added."""
        finding = self.last.findings[0]
        return replace(
            self, steps=(*self.steps, ImprovementStep(finding, self.current, finding.fit))
        )

    def without(self, effect: str, seed: int) -> ImprovementPath:
        """The path without one effect; the steps after it are fitted again, in order."""
        place = next(k for k, step in enumerate(self.steps) if step.finding.effect == effect)
        dropped = self.steps[place]
        steps = list(self.steps[:place])
        current = dropped.before
        for step in self.steps[place + 1 :]:
            again = _refitted(step, current, self.last.noise_floor, seed)
            steps.append(again)
            current = again.after
        later = Superfluous(effect, dropped.before, self.steps[-1].finding.effect)
        return replace(self, steps=tuple(steps), superfluous=(*self.superfluous, later))


def improvement_paths(
    start: Fit,
    *,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    progress: Callable[[str], None] = lambda sentence: None,
) -> Iterator[ImprovementPath]:
    """The path of the loop after each effect that is added or dropped.

    The loop ends where nothing passes the test, or after `most_steps`. The last diagnosis of the
    last path is that of its current model. Parameters as in `improve`.
    """
    steps: tuple[ImprovementStep, ...] = ()
    gone: tuple[Superfluous, ...] = ()
    while True:
        current = steps[-1].after if steps else start
        progress(f"searching for effects that {current.model.spec} lacks")
        found = diagnose(
            current,
            least_fall=least_fall,
            rejected={*rejected, *(s.effect for s in gone)},
            candidates=candidates,
            seed=seed,
            sample_rows=start.recording.rows,
            brief=True,
        )
        path = ImprovementPath(start, found, steps, gone)
        if not found.findings or len(steps) >= most_steps:
            yield path
            return
        progress(f"adding {found.findings[0].effect}")
        path = path.with_best()
        yield path
        shorter = _shortened(path, least_fall, seed, progress)
        if shorter is not None:
            path = shorter
            yield path
        steps, gone = path.steps, path.superfluous


def _refitted(step: ImprovementStep, before: Fit, floor: NoiseFloor, seed: int) -> ImprovementStep:
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
    return ImprovementStep(finding, before, after)


def _shortened(
    path: ImprovementPath, least_fall: float, seed: int, progress: Callable[[str], None]
) -> ImprovementPath | None:
    """The path without an effect that is superfluous; None where none is, or it must stay."""
    idle = _superfluous(path.steps, least_fall, seed)
    if idle is None:
        return None
    progress(f"{idle} is superfluous: refitting the later effects without it")
    try:
        return path.without(idle, seed)
    except FitError as error:
        # For example a bristle whose dry friction is positive only with this effect.
        progress(f"{idle} stays: {error}")
        return None


def _superfluous(steps: tuple[ImprovementStep, ...], least_fall: float, seed: int) -> str | None:
    """An earlier effect without which the error is not significantly larger, if there is one."""
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
        level = rms(current.weighted(current.residual[rows]))
        rise = rms(current.weighted(without.residual[rows])) / level - 1.0
        if rise < least_fall / 2 or evidence(without, current).p_value > SIGNIFICANCE:
            return effect
    return None
