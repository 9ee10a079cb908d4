"""Effects that are proxies for another dependence on the same channel.

The form of some effects is fixed by physics: an error of inertia is proportional to acceleration,
gravity varies with the sine and cosine of the angle, a wrong torque constant with the torque. If
a free function of the channel, added to such an effect, explains much of what the effect itself
explained, the torque depends on that channel in another way. Then the effect is not the cause, nor
are other effects that owe what they explain to the same dependence. If it explains less, but more
than noise does, an effect of any form on that channel is an alternative.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.trials.evidence import held_out_square
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit, held_out_with_columns
from stribeck.diagnosis.trials.trial import Trial
from stribeck.effect.base import FixedForm
from stribeck.effect.registry import find, of_catalog
from stribeck.fitting.result import Fit
from stribeck.identify.errors.added_torque import added_torque_test
from stribeck.models.catalog import effect_row

Array = NDArray[np.float64]

#: A free function that explains this share of what the effect explained shows another dependence.
SHARE = 0.25
#: Probability of noise of five standard errors: causes in the measurement bend a form by less.
CLEAR = 5.7e-7
#: An effect that keeps less than this share of what it explains, once free functions of another
#: channel are added, owes it to that channel.
MOST = 0.5


def without_proxies(before: Fit, good: list[Trial]) -> list[Trial]:
    """Trials, best first, without the proxies for another dependence on their channel."""
    kept = list(good)
    for rank, trial in enumerate(good):
        form = _fixed_form(trial.effect)
        if trial not in kept or form is None:
            continue
        columns = form.free_functions(trial.fit)
        if not columns or not _is_proxy(before, trial, np.column_stack(columns)):
            continue
        kept.remove(trial)
        extra = np.column_stack(form.free_functions(before))
        kept = [
            other
            for other in kept
            if other in good[:rank]
            or form.channel in _channels(other.effect)
            or not _owes_to(before, other, extra)
        ]
    return kept


def _is_proxy(before: Fit, trial: Trial, extra: Array) -> bool:
    """Whether free functions, columns [m, k], explain more than the effect does.

    Beside a constant torque, which depends on no channel: it is another effect.
    """
    constant = np.ones((extra.shape[0], 1))

    def square(fit: Fit, columns: Array) -> float:
        return float(np.sum(held_out_with_columns(fit, columns, before) ** 2))

    own = square(trial.fit, constant)
    left = square(trial.fit, np.column_stack([constant, extra]))
    return own - left > SHARE * (square(before, constant) - own)


def alike(effect: str, before: Fit, after: Fit) -> tuple[str, ...]:
    """Effects that a recording cannot tell from one in a fit, whatever their held-out errors."""
    known = find(effect)
    names = () if known is None else known.alike(before, after)
    return (*names, *alike_in_form(effect, after))


def alike_in_form(effect: str, after: Fit) -> tuple[str, ...]:
    """Effects of any form on the channel of one in a fit, where its form does not fit exactly."""
    form = _fixed_form(effect)
    names = () if form is None else form.alike(after)
    return () if not names or fits_exactly(effect, after) else names


def fits_exactly(effect: str, after: Fit) -> bool:
    """Whether a free form of an effect in a fit adds nothing clear to it.

    Beside a constant torque. An effect without a free form is not known to fit exactly.
    """
    form = _fixed_form(effect)
    columns = (
        of_catalog(effect).flexible_shape(after) if form is None else form.free_functions(after)
    )
    if not columns:
        return False
    extra = np.column_stack(columns)
    constant = np.ones((extra.shape[0], 1))
    free = FlexibleRefit.beside(after, constant)
    without, residual = free.residual, free.instead(np.column_stack([constant, extra])).residual
    return added_torque_test(without - residual, residual, extra.shape[1]) >= CLEAR


def _owes_to(before: Fit, other: Trial, extra: Array) -> bool:
    """Whether free functions explain most of what another effect explains."""
    without = float(np.sum(held_out_with_columns(before, extra, before) ** 2))
    along = float(np.sum(held_out_with_columns(other.fit, extra, before) ** 2))
    return without - along < MOST * (
        held_out_square(before, before) - held_out_square(other.fit, before)
    )


def _fixed_form(effect: str) -> FixedForm | None:
    known = find(effect)
    return None if known is None else known.fixed_form


def _channels(effect: str) -> list[str]:
    row = effect_row(effect)
    return [] if row is None else row["channels"]
