"""Effects that stand in for something else of the same channel.

The form of some causes is fixed by physics: an error of inertia is proportional to acceleration,
gravity goes with the sine and cosine of the angle, a wrong torque constant with the torque. If,
beside such an effect, a free function of its channel still explains much of what the effect itself
did, the torque depends on that channel in another way: the effect is not the cause, nor are those
that only share in the same dependence.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.beside import held_out_beside
from stribeck.diagnosis.shape import hats, powers, waves
from stribeck.diagnosis.trial import Trial
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_row

Array = NDArray[np.float64]

#: A free function of the channel that explains this share of what the effect did shows another.
SHARE = 0.25
#: An effect that keeps less than this share of what it explains, beside free functions of another
#: channel, owes it to that channel.
MOST = 0.5


def _of_acceleration(fit: Fit) -> list[Array]:
    a = fit.recording.acceleration
    return [] if a is None else [np.sign(a[fit.rows]), *hats(a[fit.rows], 9)]


def _of_position(fit: Fit) -> list[Array]:
    q = fit.recording.position
    return [] if q is None else waves(q[fit.rows], range(1, 8))


def _of_torque(fit: Fit) -> list[Array]:
    total = fit.prediction[fit.rows]
    return powers(total, float(np.abs(total).max()))


#: Effects of fixed form: their channel, and free functions of it on the rows fitted to.
FIXED_FORM: dict[str, tuple[str, Callable[[Fit], list[Array]]]] = {
    "inertia": ("acceleration", _of_acceleration),
    "gravity": ("position", _of_position),
    "gain": ("load_torque", _of_torque),
}


def without_stand_ins(before: Fit, good: list[Trial]) -> list[Trial]:
    """Trials, best first, without those that stand in for another dependence on their channel."""
    kept = list(good)
    for rank, trial in enumerate(good):
        if trial not in kept or trial.effect not in FIXED_FORM:
            continue
        channel, free_functions = FIXED_FORM[trial.effect]
        columns = free_functions(trial.fit)
        if not columns or not _stands_in(before, trial, np.column_stack(columns)):
            continue
        kept.remove(trial)
        extra = np.column_stack(free_functions(before))
        kept = [
            other
            for other in kept
            if other in good[:rank]
            or channel in _channels(other.effect)
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


def _channels(effect: str) -> list[str]:
    row = effect_row(effect)
    return [] if row is None else row["channels"]
