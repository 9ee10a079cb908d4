"""Effects that stand in for something else of the same channel.

The form of some causes is fixed by physics: an error of inertia is proportional to acceleration,
gravity goes with the sine and cosine of the angle, a wrong torque constant with the torque. If,
beside such an effect, a free function of its channel still explains much of what the effect itself
did, the torque depends on that channel in another way: the effect is not the cause, nor are those
that only share in the same dependence.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.beside import held_out_beside
from stribeck.diagnosis.trial import Trial
from stribeck.effect.base import FixedForm
from stribeck.effect.registry import find
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_row

Array = NDArray[np.float64]

#: A free function of the channel that explains this share of what the effect did shows another.
SHARE = 0.25
#: An effect that keeps less than this share of what it explains, beside free functions of another
#: channel, owes it to that channel.
MOST = 0.5


def without_stand_ins(before: Fit, good: list[Trial]) -> list[Trial]:
    """Trials, best first, without those that stand in for another dependence on their channel."""
    kept = list(good)
    for rank, trial in enumerate(good):
        form = _fixed_form(trial.effect)
        if trial not in kept or form is None:
            continue
        columns = form.free_functions(trial.fit)
        if not columns or not _stands_in(before, trial, np.column_stack(columns)):
            continue
        kept.remove(trial)
        extra = np.column_stack(form.free_functions(before))
        kept = [
            other
            for other in kept
            if other in good[:rank]
            or form.channel in _channels(other.effect)
            or not _shares(before, other, extra)
        ]
    return kept


def _stands_in(before: Fit, trial: Trial, extra: Array) -> bool:
    """Whether free functions, columns [m, k], go on explaining where the effect ends."""
    left = float(np.sum(held_out_beside(trial.fit, extra) ** 2))
    return trial.square - left > SHARE * (_square(before) - trial.square)


def _shares(before: Fit, other: Trial, extra: Array) -> bool:
    """Whether free functions take away most of what another effect explains."""
    without = float(np.sum(held_out_beside(before, extra) ** 2))
    along = float(np.sum(held_out_beside(other.fit, extra) ** 2))
    return without - along < MOST * (_square(before) - other.square)


def _square(fit: Fit) -> float:
    return float(np.sum(fit.held_out_residual[fit.rows] ** 2))


def _fixed_form(effect: str) -> FixedForm | None:
    known = find(effect)
    return None if known is None else known.fixed_form


def _channels(effect: str) -> list[str]:
    row = effect_row(effect)
    return [] if row is None else row["channels"]
