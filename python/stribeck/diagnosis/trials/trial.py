"""Try one effect: refit with it, and test the evidence."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import scipy

from stribeck.base.errors import StribeckError
from stribeck.base.memo import Memo
from stribeck.diagnosis.measurement.late_channels import REACH
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.shape import KEPT, share_kept, usual_shape
from stribeck.diagnosis.plausibility.shape import STARTS as SHAPE_STARTS
from stribeck.diagnosis.plausibility.unresolved import out_of_reach, unresolved
from stribeck.diagnosis.trials.evidence import Evidence, difference, evidence, held_out_square
from stribeck.diagnosis.trials.screening import STARTS, Screened, extended_model, screened
from stribeck.diagnosis.visibility.model_space import MOST_ROWS
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span
from stribeck.effect.base import number
from stribeck.effect.describe import acts_in_shocks, is_friction
from stribeck.effect.registry import find
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.errors.at_bound import wider
from stribeck.identify.errors.estimates import Estimate
from stribeck.identify.problem import Problem
from stribeck.identify.search.effort import FROM_NEARBY, QUICK, THOROUGH
from stribeck.identify.stated.choices import Choices
from stribeck.models.catalog import catalog, simpler_effect
from stribeck.models.formula_law import effect_name
from stribeck.models.model import Model

#: An effect is promising from this share of the fall that it must bring.
PROMISE = 0.5
#: Significance level of a finding, over all effects tried together.
SIGNIFICANCE = 0.01
#: Among effects whose held-out errors differ by less than one standard error, the simplest wins.
SIMPLEST = 1.0
#: Held-out errors within this many standard errors are not significantly different.
TIE = 2.0
#: Cosine of the angle between two torques from which one may be tried in place of the other.
RESEMBLING = 0.7


@dataclass(frozen=True)
class Trial:
    """One effect added to a model and fitted, and the evidence for it."""

    effect: str
    fit: Fit
    evidence: Evidence

    @property
    def parameters(self) -> int:
        """Number of parameters of the wider model."""
        return len(self.fit.model.names)

    @property
    def rank(self) -> float:
        """Order of trials, smallest first: the remaining error, raw and in the motion's band.

        The sum of both logarithms. In white noise they agree; where vibration dominates the raw
        error, an effect that only follows the vibration does not outrank one in the motion's band.
        """
        falls = np.array([self.evidence.fall, self.evidence.fall_in_band])
        return float(np.sum(np.log(np.maximum(1.0 - falls, 1e-12))))

    @property
    def size(self) -> Estimate | None:
        """The size of the effect, its first parameter: a height, a slope, a stiffness, a delay."""
        return size_of(self.effect, self.fit)

    @property
    def shows_in_band(self) -> bool:
        """Whether the error falls in the band of the motion, or the effect acts in shocks.

        A shock is faster than the motion, and its place in time tells it from vibration.
        """
        return self.evidence.fall_in_band > 0 or acts_in_shocks(self.effect)

    @property
    def is_implausible(self) -> bool:
        """Whether the effect's size is at its bound: the fit uses it as a proxy for another."""
        return self.size is not None and self.size.at_bound

    @property
    def samples_late(self) -> float:
        """By how many samples the effect delays friction; infinite where it does not."""
        known = find(self.effect)
        return np.inf if known is None else known.samples_late(self.fit)

    @property
    def is_within_a_sample(self) -> bool:
        """Whether the effect delays friction by less than a sample."""
        return self.samples_late < 1.0

    @property
    def is_beyond_band(self) -> bool:
        """Whether the effect acts above the frequencies at which the motion is known."""
        known = find(self.effect)
        return known is not None and known.beyond_band(self.fit) is not None

    def only_delays(self, effect: str) -> bool:
        """Whether it is another effect that lags by a few samples."""
        return self.samples_late <= REACH and simpler_effect(self.effect) == effect

    @property
    def bound_reason(self) -> str:
        """Why an effect whose size is at its bound is not claimed."""
        assert self.size is not None
        return bound_reason(self.size)


def size_of(effect: str, fit: Fit) -> Estimate | None:
    """The size of an effect in a fit: its first parameter."""
    own = fit.model.formula(effect)
    if own is None:
        name = catalog()["effects"][effect]["parameters"][0]["name"]
    else:
        name = own.names[0]
    return fit.estimates.get(name)


def bound_reason(size: Estimate) -> str:
    """Why an effect with a size at its bound is not claimed."""
    unit = "" if size.unit == "1" else f" {size.unit}"
    return (
        f"its {size.name} would be at its bound {number(size.value)}{unit}: the effect may imitate "
        f"another cause; if a value beyond is possible, {wider(size)}"
    )


#: The trials that followed screenings beside a fit.
_FOLLOWED: Memo[Fit, Trial | None] = Memo()


def add_effect(
    before: Fit,
    effect: str,
    *,
    starts: int = STARTS,
    seed: int = 0,
) -> Fit:
    """Refit the model of `before` with `effect` added, from the known values.

    Raises
    ------
    SpecError, FitError
        The effect is in the model already, or needs a channel that the recording lacks.
    """
    return fit(
        extended_model(before, effect),
        before.recording,
        starts=starts,
        seed=seed,
        transient=before.transient,
    )


def is_promising(found: Screened, least: float) -> bool:
    """Whether an effect that was tried on few samples may bring the fall `least` on all."""
    return found.fall >= PROMISE * least


def try_effect(before: Fit, promising: Screened) -> Trial | None:
    """Fit an effect to all samples after its screening; None where that is impossible.

    Where a shape parameter ends at a bound, and the effect then acts within what the recording
    resolves or beyond what it reaches, that parameter is held at its usual value if the effect
    keeps most of its gain: the recording does not determine it. The bounds that a user gave stand.
    The same screening is followed once.
    """
    return _FOLLOWED.of(before, promising, lambda: _followed(before, promising))


def _followed(before: Fit, promising: Screened) -> Trial | None:
    free = _tried(before, promising.effect, promising.model)
    if free is None or free.evidence.fall <= 0.0:
        return free
    limits = free.fit.model.limits
    usual = {k: v for k, v in usual_shape(free.effect, free.fit).items() if k not in limits}
    if not usual or not _is_out_of_range(before, free):
        return free
    model = Choices(fix=usual).applied(extended_model(before, promising.effect))
    plain = _tried(before, promising.effect, model, starts=SHAPE_STARTS)
    if (
        plain is None
        or _is_out_of_range(before, plain)
        or share_kept(before, free.fit, plain.fit) < KEPT
    ):
        return free
    return plain


def _is_out_of_range(before: Fit, trial: Trial) -> bool:
    claim = Claim(trial.effect, before, trial.fit)
    return unresolved(claim) is not None or out_of_reach(claim) is not None


def _tried(before: Fit, effect: str, model: Model, starts: int = 1) -> Trial | None:
    """The trial of an effect with a model that has it."""
    try:
        after = fit(
            model, before.recording, transient=before.transient, effort=QUICK, starts=starts
        )
    except StribeckError:
        return None
    if after.rmse_held_out is None or before.rmse_held_out is None:
        return None
    return Trial(effect_name(effect), after, evidence(before, after))


def try_beyond(
    simpler: Trial, effect: str, before: Fit, least: float, *, seed: int = 0
) -> tuple[Trial, Trial] | None:
    """Try `effect` on top of the simpler one that it contains.

    Returns
    -------
    The trial of the effect beside the simpler one, and of both together beside `before`; None
    where the effect explains nothing more, or the model cannot take it.
    """
    beyond = _try_if_promising(simpler.fit, effect, least, seed)
    if beyond is None:
        return None
    return beyond, Trial(effect, beyond.fit, evidence(before, beyond.fit))


def simpler_substitute(
    beyond: Trial,
    simpler: Trial,
    others: list[Trial],
    possible: Collection[str],
    before: Fit,
    least: float,
    seed: int,
) -> tuple[Trial, ...] | None:
    """What replaces `beyond`, which contains `simpler`: that and another effect, with less.

    Both together have fewer parameters. Their held-out error is within one standard error, or
    exceeds that of `beyond` by less than a finding must bring. Example: a load dependence that
    differs between motoring and generating, against one that does not differ and a wrong torque
    constant.

    Parameters
    ----------
    others
        Trials that pass beside `before`; the one whose torque is most similar is tried.
    possible
        Effects; the one that explains most beside `simpler` is tried.

    Returns
    -------
    The trials of both beside `before`, or that of `simpler` alone where the other shows only beside
    it; None where nothing replaces `beyond`.
    """
    similar = _most_similar(beyond, simpler, others, before)
    if similar is not None:
        effect = similar.fit.model.written(similar.effect)
        if _is_replaced(beyond, simpler, screened(simpler.fit, effect, seed=seed), least):
            return simpler, similar
    tried = {beyond.effect, simpler.effect, *(() if similar is None else (similar.effect,))}
    screenings = (screened(simpler.fit, e, seed=seed) for e in possible if e not in tried)
    best = max((s for s in screenings if s is not None), key=lambda s: s.fall, default=None)
    return (simpler,) if _is_replaced(beyond, simpler, best, least) else None


def _is_replaced(beyond: Trial, simpler: Trial, other: Screened | None, least: float) -> bool:
    """Whether an effect, screened beside `simpler`, replaces `beyond` together with that."""
    if other is None or len(other.model.names) >= beyond.parameters:
        return False
    if not is_promising(other, least):
        return False
    both = try_effect(simpler.fit, other)
    if both is None:
        return False
    rows = simpler.fit
    lost = held_out_square(beyond.fit, rows) / held_out_square(both.fit, rows)
    return tie_statistic(beyond, both) <= SIMPLEST or 1.0 - lost**0.5 < least


def _most_similar(beyond: Trial, simpler: Trial, others: list[Trial], before: Fit) -> Trial | None:
    """The one of `others` whose torque is most similar to what `beyond` adds to `simpler`."""
    if not others:
        return None
    fit = simpler.fit
    rows = fit.rows[:: -(-fit.rows.size // MOST_ROWS)]
    _, tangent = Problem(fit.recording, fit.model, rows, fit.load).linearise(fit.model.values)
    basis = orthonormal(tangent)
    torques = [beyond.fit.prediction - fit.prediction]
    torques += [other.fit.prediction - before.prediction for other in others]
    left = outside_span(basis, np.column_stack([torque[rows] for torque in torques]))
    size = np.sqrt(np.sum(left**2, axis=0))
    cosines = np.abs(left.T @ left[:, 0])[1:] / np.maximum(size[1:] * size[0], 1e-300)
    best = int(np.argmax(cosines))
    return others[best] if cosines[best] > RESEMBLING else None


def _try_if_promising(before: Fit, effect: str, least: float, seed: int) -> Trial | None:
    """Try an effect if its screening is promising."""
    found = screened(before, effect, seed=seed)
    return try_effect(before, found) if found is not None and is_promising(found, least) else None


def refined(trial: Trial, before: Fit, seed: int = 0) -> Trial:
    """The same trial fitted thoroughly, from its values.

    With a state, whose every evaluation simulates the whole recording, no other minimum is sought:
    the screening has searched from several starts.
    """
    after = fit(
        trial.fit.model,
        trial.fit.recording,
        starts=1,
        seed=seed,
        transient=trial.fit.transient,
        effort=THOROUGH if trial.fit.model.memoryless else FROM_NEARBY,
    )
    return Trial(trial.effect, after, evidence(before, after))


def passes(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial passes: large enough, in several blocks, and significant among `tried`."""
    return trial.evidence.everywhere and _passes_somewhere(trial, tried, least)


def passes_in_one_block(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial would pass, but gains in one block alone."""
    return not trial.evidence.everywhere and _passes_somewhere(trial, tried, least)


def passes_at_a_bound(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial would pass, but its size is at its bound."""
    e = trial.evidence
    gains = e.everywhere and trial.shows_in_band
    return trial.is_implausible and gains and _is_more_than_chance(trial, tried, least)


def passes_outside_the_band(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial would pass, but gains only at frequencies above those of the motion."""
    e = trial.evidence
    return e.everywhere and not trial.shows_in_band and _is_significant(trial, tried, least)


def is_uncertain(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial predicts better in most blocks, but not by more than chance may."""
    e = trial.evidence
    falls = e.everywhere and e.is_large(least, tried) and trial.shows_in_band
    return falls and e.p_value * tried > SIGNIFICANCE and not trial.is_implausible


def _passes_somewhere(trial: Trial, tried: int, least: float) -> bool:
    return trial.shows_in_band and _is_significant(trial, tried, least)


def _is_significant(trial: Trial, tried: int, least: float) -> bool:
    return _is_more_than_chance(trial, tried, least) and not trial.is_implausible


def _is_more_than_chance(trial: Trial, tried: int, least: float) -> bool:
    e = trial.evidence
    return e.is_large(least, tried) and e.p_value * tried <= SIGNIFICANCE


def falls_on_all_samples(before: Fit, trial: Trial) -> bool:
    """Whether the error over all scored samples falls too, transients included.

    With a robust loss the error is weighted: that of outliers alone may rise or fall by chance.
    """
    assert before.rmse_held_out is not None and trial.fit.rmse_held_out is not None
    if before.loss_weight is None:
        return trial.fit.rmse_held_out < before.rmse_held_out
    at = before.scored
    weight = before.loss_weight[at]
    gain = before.held_out_residual[at] ** 2 - trial.fit.held_out_residual[at] ** 2
    return bool(np.sum(weight * gain) > 0.0)


def tie_statistic(best: Trial, other: Trial) -> float:
    """Standard errors by which `other`'s held-out error exceeds `best`'s.

    Where neither is friction, also at reversals: those are excluded because friction differs there,
    and a delay, an inertia or a gain acts there as anywhere.
    """
    everywhere = not (is_friction(best.effect) or is_friction(other.effect))
    return difference(other.fit, best.fit, everywhere=everywhere).statistic


def tie_weight(statistic: float) -> float:
    """Two-sided probability of a difference this large or larger by chance."""
    return float(2.0 * scipy.special.ndtr(-abs(statistic)))


def adds_to(first: Trial, other: Trial, tried: int, least: float, seed: int = 0) -> bool:
    """Whether the effect of `other` explains something that the effect of `first` does not."""
    again = _try_if_promising(first.fit, other.fit.model.written(other.effect), least, seed)
    return again is not None and passes(again, tried, least)
