"""Effects that causes in the measurement explain as well.

A filter, a lag, an amplifier that warms up or a wrong scale of the load leaves errors that friction
can imitate. A friction effect stands if it explains something beside the columns of all these
causes, or predicts better than they do. Otherwise it is not claimed where they predict better, and
demoted where both do equally well.

Other effects must stand beside the causes that look like them. A drive train that twists smooths
the load torque, as a filter of it does: it is never certain where all causes predict as well.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from stribeck.base.pool import on_each
from stribeck.diagnosis.least_fall import reduced
from stribeck.diagnosis.measurement.late_channels import REACH
from stribeck.diagnosis.measurement.other_acceleration import OTHER_ACCELERATION
from stribeck.diagnosis.measurement.table import (
    imitating,
    least_factors,
    measurement_columns,
    without_effect,
)
from stribeck.diagnosis.plausibility.rules import DEMOTED
from stribeck.diagnosis.trials.evidence import Difference, held_out_square
from stribeck.diagnosis.trials.flexible_refit import Array, FlexibleRefit
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, SIMPLEST, TIE, Trial
from stribeck.effect.describe import is_drive_train, is_friction
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_ids, simpler_effect

#: A constant torque, as a cause in the measurement.
ZERO = "a zero of the torque that is off"
#: The highest confidence of an effect that predicts better than the causes in the measurement by no
#: more than one standard error: about as often it is right on simulated recordings.
NARROW = 0.95
#: Share of what an effect explains from which on another cause puts it in doubt.
MUCH = 0.5


def beside_causes(before: Fit, columns: Mapping[str, Array]) -> FlexibleRefit:
    """A fit with the `columns` [m, k] of several causes in the measurement, by name."""
    return FlexibleRefit.beside(before, _beside_each_other(columns), least_factors(columns))


def explained_by_causes(current: Fit) -> float:
    """The share of a fit's squared held-out error that causes in the measurement explain.

    Below 0 where their columns, fitted to the other blocks, raise it.
    """
    columns = measurement_columns(current)
    if not columns:
        return 0.0
    left = float(np.sum(beside_causes(current, columns).held_out ** 2))
    return 1.0 - left / held_out_square(current, current)


def _beside_each_other(columns: Mapping[str, Array]) -> Array:
    return np.column_stack(list(columns.values()))


@dataclass(frozen=True)
class _Rivals:
    """The causes in the measurement beside a fit: each alone, and all together."""

    before: Fit
    alone: Mapping[str, FlexibleRefit]
    together: FlexibleRefit

    @classmethod
    def beside(cls, before: Fit, columns: Mapping[str, Array]) -> _Rivals:
        """The causes with their `columns` [m, k], by name."""
        together = beside_causes(before, columns)
        refits = on_each(
            lambda what: together.instead(columns[what], least_factors({what: columns[what]})),
            columns,
        )
        return cls(before, dict(zip(columns, refits, strict=True)), together)

    def of(self, effect: str) -> _Rivals | None:
        """Those that act on the fit without an effect; None where there are none."""
        acting = without_effect(
            {what: refit.columns for what, refit in self.alone.items()}, effect, self.before
        )
        if len(acting) == len(self.alone):
            return self
        if not acting:
            return None
        together = self.together.instead(_beside_each_other(acting), least_factors(acting))
        return _Rivals(self.before, {what: self.alone[what] for what in acting}, together)

    def only(self, what: str) -> _Rivals | None:
        """One of them; None where it has no columns."""
        one = self.alone.get(what)
        return None if one is None else _Rivals(self.before, {what: one}, one)

    def leave(self, trial: Trial, tried: int, needed: float) -> bool:
        """Whether a trial lowers the error beside all of them, by at least the share `needed`."""
        fall, p_value = self.together.beside_columns(trial)
        return fall >= needed and p_value * tried <= SIGNIFICANCE

    def advantage(self, trial: Trial) -> float:
        """Standard errors by which they leave a larger held-out error than a trial."""
        return self.together.advantage(trial)

    def let_stand(self, trial: Trial, tried: int, least: float) -> bool:
        """Whether a trial predicts better than all of them, or adds to them.

        One that predicts better at all need not add much.
        """
        better = self.advantage(trial)
        return better > TIE or self.leave(trial, tried, 0.0 if better > 0.0 else reduced(least))

    def share_of(self, trial: Trial) -> float:
        """What they explain of the squared held-out error, as a share of what a trial does.

        0 where that is less than two standard errors.
        """
        before, rows = self.before, self.before.rows
        own = before.weighted(before.held_out_residual[rows]) ** 2
        gain = Difference.of(own - self.together.held_out**2)
        fall = held_out_square(before, before) - held_out_square(trial.fit, before)
        return gain.total / fall if gain.statistic > TIE else 0.0

    @property
    def largest(self) -> str:
        """The cause that alone leaves the smallest held-out error."""
        return min(self.alone, key=lambda what: float(np.sum(self.alone[what].held_out ** 2)))


def without_imitations(
    before: Fit, sift: Sifted, passed: Sequence[Trial], tried: int, least: float
) -> Sifted:
    """The same without effects that causes in the measurement explain as well.

    Parameters
    ----------
    passed
        Trials that passed the test of evidence: of an effect that contains a simpler one among
        them, what it adds to that must stand too.
    """
    for trial in sift.stand:
        if trial.is_within_a_sample:
            sift = sift.narrowed(trial, DEMOTED)
    suspects = [t for t in sift.stand if is_friction(t.effect) or imitating(t.effect)]
    columns = measurement_columns(before) if suspects else {}
    if not columns:
        return sift
    of_measurement = _Rivals.beside(before, columns)
    for trial in suspects:
        if not is_friction(trial.effect):
            sift = _other_judged(sift, trial, of_measurement, tried, least)
            continue
        unseen = _lacks_simpler(trial, before, passed)
        rivals = _with_zero(before) if unseen else of_measurement.of(trial.effect)
        if rivals is None:
            continue
        better = rivals.advantage(trial)
        if unseen:
            # Its simpler part shows nothing alone: the wider one must also add to the causes.
            stands = better > SIMPLEST and rivals.leave(trial, tried, reduced(least))
        else:
            stands = rivals.let_stand(trial, tried, least)
        if not stands:
            sift = sift.instead(trial, _explained(trial, rivals, better))
            continue
        addition = _beside_simpler(trial, passed)
        if addition is not None and not addition.leave(trial, tried, reduced(least)):
            reason = f"{addition.largest} explains what it adds to {simpler_effect(trial.effect)}"
            sift = sift.instead(trial, Sifted(demoted=(Doubted(trial, reason),)))
            continue
        apart = min(r.advantage(trial) for r in (rivals, addition) if r is not None)
        if apart > SIMPLEST:
            continue
        if trial.samples_late <= REACH:
            largest = (rivals if addition is None else addition).largest
            reason = f"it delays friction by a few samples, and {largest} explains that as well"
            row = Doubted(trial, reason)
            sift = sift.instead(trial, Sifted(demoted=(row,)))
        else:
            sift = sift.narrowed(trial, NARROW)
    return sift


def _explained(trial: Trial, rivals: _Rivals, better: float) -> Sifted:
    """A trial that its rivals explain, predicting `better` than they do by standard errors."""
    if better < -TIE:
        reason = f"{rivals.largest} explains all that it does, and more"
        return Sifted(refused=(Doubted(trial, reason),))
    return Sifted(demoted=(Doubted(trial, f"{rivals.largest} explains it as well"),))


def _other_judged(sift: Sifted, trial: Trial, rivals: _Rivals, tried: int, least: float) -> Sifted:
    """The same, with an effect that is no friction judged beside the causes that look like it.

    One that acts in the joint must predict better than each of them, and is in doubt where a load
    torque of another acceleration explains much of what it does.
    """
    alone = {what: one for what in imitating(trial.effect) if (one := rivals.only(what))}
    in_joint = of_catalog(trial.effect).in_motion != "measurement"
    for one in alone.values():
        better = one.advantage(trial)
        if not one.let_stand(trial, tried, least) or (in_joint and better <= SIMPLEST):
            return sift.instead(trial, _explained(trial, one, better))
    other = alone.get(OTHER_ACCELERATION.what)
    if in_joint and other is not None and other.share_of(trial) >= MUCH:
        reason = f"{OTHER_ACCELERATION.what} explains much of what it does"
        return sift.instead(trial, Sifted(demoted=(Doubted(trial, reason),)))
    if not is_drive_train(trial.effect):
        return sift
    return sift.narrowed(trial, _most_certain(trial, rivals))


def _most_certain(trial: Trial, rivals: _Rivals) -> float:
    """The highest confidence of an effect of the drive train beside all causes together.

    Together they smooth the load torque as it does, so that what it adds to them says nothing.
    Where they predict better it is as likely as not, where they predict as well it is not certain.
    One above the frequencies at which the motion is known is as likely as not too.
    """
    better = rivals.advantage(trial)
    if better < -TIE or trial.is_beyond_band:
        return DEMOTED
    return NARROW if better <= SIMPLEST else 1.0


def most_certain(trial: Trial, before: Fit) -> float:
    """The highest confidence of an effect of the drive train beside causes in the measurement."""
    columns = measurement_columns(before)
    return _most_certain(trial, _Rivals.beside(before, columns)) if columns else 1.0


def standing(before: Fit, trial: Trial, passed: Sequence[Trial], least: float) -> Sifted:
    """What stands of one trial, where every effect of the catalog counts as tried."""
    return without_imitations(before, Sifted(stand=(trial,)), passed, len(effect_ids()), least)


def _lacks_simpler(trial: Trial, before: Fit, passed: Sequence[Trial]) -> bool:
    """Whether a trial contains a simpler effect that has not passed."""
    simpler = simpler_effect(trial.effect)
    known = simpler is None or before.model.has(simpler)
    return not known and all(t.effect != simpler for t in passed)


def _beside_simpler(trial: Trial, passed: Sequence[Trial]) -> _Rivals | None:
    """The causes beside a simpler effect that a trial contains; None where that has not passed."""
    simpler = next((t for t in passed if t.effect == simpler_effect(trial.effect)), None)
    return None if simpler is None else _with_zero(simpler.fit)


def _with_zero(before: Fit) -> _Rivals:
    """The causes beside a fit; a constant among them: the zero of the torque."""
    zero = np.ones((before.rows.size, 1))
    return _Rivals.beside(before, {**measurement_columns(before), ZERO: zero})
