"""What the loop has added to a model, and what it dropped again."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stribeck.diagnosis.loop.exchange import Exchange, Exchanges, exchanges, tied, ties_of
from stribeck.diagnosis.loop.superfluous import (
    Needed,
    brought_by,
    model_without,
    without_effects,
    without_influence,
)
from stribeck.diagnosis.plausibility.rules import DEMOTED
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.ranking import share_of_unexplained
from stribeck.diagnosis.trials.remainder import part_explained, unknown_structure
from stribeck.effect.describe import is_drive_train, where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search.effort import FROM_NEARBY
from stribeck.models.formula_law import effect_name
from stribeck.models.model import Model
from stribeck.recording.recording import Recording


@dataclass(frozen=True)
class ImprovementStep:
    """One accepted finding, and the model with it.

    Attributes
    ----------
    rivals
        Other effects that passed the test of evidence beside it, ids or formulas, the best first;
        before them what it took the place of.
    """

    finding: Finding
    before: Fit
    after: Fit
    rivals: tuple[str, ...] = ()

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
class Dropped:
    """An effect that was dropped, why, and the model it had been added to."""

    effect: str
    before: Fit
    reason: str


@dataclass(frozen=True)
class ImprovementPath:
    """The state of the loop: what it has added to `start` so far.

    Attributes
    ----------
    steps
        What was added, in order.
    dropped
        What was added and then dropped; these effects are not tried again.
    demoted
        Those of them that the recording needs, but that may be another cause.
    last
        The last diagnosis: of `current`, or of the model before the last change.
    """

    start: Fit
    last: Diagnosis
    steps: tuple[ImprovementStep, ...] = ()
    dropped: tuple[Dropped, ...] = ()
    demoted: tuple[Finding, ...] = ()

    @property
    def current(self) -> Fit:
        """The model at the end of the path."""
        return self.steps[-1].after if self.steps else self.start

    def with_best(self) -> ImprovementPath:
        """The path with the best finding of the last diagnosis added."""
        return self.with_found(self.last.findings[0])

    def with_found(self, finding: Finding) -> ImprovementPath:
        """The path with a finding of the last diagnosis added."""
        rivals = tuple(e for e in self.last.passed if effect_name(e) != finding.effect)
        return self.with_finding(finding, rivals)

    def with_finding(self, finding: Finding, rivals: tuple[str, ...] = ()) -> ImprovementPath:
        """The path with a finding added."""
        step = ImprovementStep(finding, self.current, finding.fit, rivals)
        return replace(self, steps=(*self.steps, step))

    def holding(self, effect: str) -> Finding | None:
        """The finding of one effect, None where it was dropped."""
        found = (step.finding for step in self.steps)
        return next((finding for finding in found if finding.effect == effect), None)

    def with_instead(self, finding: Finding) -> ImprovementPath:
        """The path with another statement of the finding of the same effect."""
        place = self._place(finding.effect)
        step = replace(self.steps[place], finding=finding)
        return replace(self, steps=(*self.steps[:place], step, *self.steps[place + 1 :]))

    def without(self, effect: str, seed: int, reason: str | None = None) -> ImprovementPath:
        """The path without one effect; the steps after it are fitted again, in order.

        An effect that has no influence without it is left out too.

        Parameters
        ----------
        reason
            Default: it is superfluous.
        """
        place = self._place(effect)
        dropped = self.steps[place]
        whole = model_without(self.current, dropped.finding)
        steps = self._refitted(dropped.before, self.steps[place + 1 :], whole, seed)
        because = reason or _superfluous(effect, steps[-1].finding.effect if steps else effect)
        gone = Dropped(effect, dropped.before, because)
        return replace(self, steps=(*self.steps[:place], *steps), dropped=(*self.dropped, gone))

    def demoting(self, effect: str, reason: str, seed: int) -> ImprovementPath:
        """The path without an effect that the recording needs, but that may be another cause."""
        finding = self.steps[self._place(effect)].finding
        shorter = self.without(effect, seed, reason)
        doubted = replace(finding, weight=min(finding.weight, DEMOTED), demoted=reason)
        return replace(shorter, demoted=(*self.demoted, doubted))

    def _place(self, effect: str) -> int:
        return next(k for k, step in enumerate(self.steps) if step.finding.effect == effect)

    def exchanged(self, exchange: Exchange, seed: int) -> ImprovementPath:
        """The path with another effect in place of one; the steps after it are fitted again.

        One that has no influence without that effect is left out, and may be found again.
        """
        place = self._place(exchange.finding.effect)
        dropped, by = self.steps[place], exchange.by
        weight = dropped.finding.weight
        if by.effect in dropped.finding.indistinguishable_from:
            # The tie that lowered it is decided, as far as whole models decide it.
            weight = max(weight, NARROW)
        finding = replace(
            dropped.finding,
            effect=by.effect,
            weight=weight,
            indistinguishable_from=(),
            before=exchange.without,
            fit=by.fit,
        )
        weight, names = tied(finding, ties_of(exchange))
        finding = replace(finding, weight=min(weight, exchange.most), indistinguishable_from=names)
        rivals = tuple(dict.fromkeys((dropped.finding.effect, *dropped.rivals)))
        step = replace(dropped, finding=finding, rivals=rivals)
        later = [step, *self.steps[place + 1 :]]
        steps = self._refitted(dropped.before, later, by.fit.model, seed)
        effect = dropped.finding.effect
        gone = Dropped(effect, dropped.before, _superfluous(effect, by.effect))
        return replace(self, steps=(*self.steps[:place], *steps), dropped=(*self.dropped, gone))

    def with_ties(self, ties: Mapping[str, Mapping[str, float]]) -> ImprovementPath:
        """The path whose findings also name effects that predict as well in their place."""
        steps = []
        for step in self.steps:
            weight, names = tied(step.finding, ties.get(step.finding.effect, {}))
            finding = replace(step.finding, weight=weight, indistinguishable_from=names)
            steps.append(replace(step, finding=finding))
        return replace(self, steps=tuple(steps))

    def with_needed(self, found: Needed) -> ImprovementPath:
        """The path with what its last model needs of some of its effects."""
        unknown = unknown_structure(self.current, self.last.unexplained) if found.gain else 0.0
        steps = []
        for step in self.steps:
            effect = step.finding.effect
            certainty = found.certainty.get(effect, step.finding.certainty)
            part = part_explained(
                found.gain.get(effect),
                unknown,
                self.last.unexplained,
                drive_train=is_drive_train(effect),
            )
            finding = replace(step.finding, certainty=certainty, part=part)
            steps.append(replace(step, finding=finding))
        return replace(self, steps=tuple(steps))

    def exchanges(self, rejected: Collection[str], least: float, seed: int) -> Exchanges:
        """What the exchange of each effect for its rivals, and for those of later ones, shows.

        An effect that may not be claimed beside the others may be right in the place of one; one
        that the recording cannot show may not.
        """
        written = self.current.model.written
        spoilt = tuple(written(row.effect) for row in self.last.not_claimed)
        pools = [
            tuple(dict.fromkeys(e for step in self.steps[k:] for e in step.rivals))
            for k in range(len(self.steps))
        ]
        hidden = {row.effect for row in self.last.untestable}
        refused = {*rejected, *hidden, *(gone.effect for gone in self.dropped)}
        findings = [step.finding for step in self.steps]
        return exchanges(findings, pools, spoilt, self.current, refused, least, seed)

    def _refitted(
        self, before: Fit, later: Sequence[ImprovementStep], whole: Model, seed: int
    ) -> list[ImprovementStep]:
        """Steps from `before` to the model `whole`, whose values are the starts.

        Those whose effect this model does not hold are left out. An effect comes after those
        without which it has no influence.
        """
        held = {*whole.effects, *whole.own_effects}
        later = [step for step in later if step.finding.effect in held]
        later = _in_order(later, whole, before.recording)
        models = [whole]
        for step in reversed(later[1:]):
            models.append(without_effects(models[-1], brought_by(step.finding)))
        steps: list[ImprovementStep] = []
        for step, model in zip(later, reversed(models[: len(later)]), strict=True):
            made = refitted(step, before, model, self.last.noise_floor, seed)
            steps.append(made)
            before = made.after
        return steps


def _in_order(
    later: Sequence[ImprovementStep], whole: Model, recording: Recording
) -> list[ImprovementStep]:
    """The steps to the model `whole`, each after those without which it has no influence."""
    waiting, made = list(later), []
    while waiting:
        for step in waiting:
            others = [s.finding for s in waiting if s is not step]
            model = without_effects(whole, [e for f in others for e in brought_by(f)])
            if step.finding.effect not in without_influence(model, recording):
                break
        else:
            step = waiting[0]
        waiting.remove(step)
        made.append(step)
    return made


def _superfluous(effect: str, because: str) -> str:
    """Why an effect is superfluous: another one, or, where it is the last one, its own gain."""
    if because != effect:
        return f"superfluous once {because} is in the model"
    return "its removal raises the held-out error by no more than one standard error"


def refitted(
    step: ImprovementStep, before: Fit, model: Model, floor: NoiseFloor, seed: int
) -> ImprovementStep:
    """The same effect added to another model: `model` has it, and values near the solution."""
    after = fit(
        model,
        before.recording,
        starts=1,
        seed=seed,
        transient=before.transient,
        effort=FROM_NEARBY,
    )
    made = replace(
        step.finding,
        rmse_held_out_before=float(before.rmse_held_out or np.nan),
        rmse_held_out_after=float(after.rmse_held_out or np.nan),
        share_of_unexplained=share_of_unexplained(before, after, floor),
        where=where(step.finding.effect, before, after),
        fit=after,
        before=before,
    )
    return replace(step, finding=made, before=before, after=after)
