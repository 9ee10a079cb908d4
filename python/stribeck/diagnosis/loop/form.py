"""Friction effects of another form: a free function of the speed explains much more.

A step of friction in a band of speed is imitated in part by a Stribeck curve. What the curve leaves
is a function of the speed as well. Of the right effect its law leaves little to a free function.

Friction always depends on the speed, so that the form alone tells such effects apart. One that
reads a channel of its own, such as the load torque, is another matter: a free function of that
channel which explains more confirms that friction depends on it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stribeck.diagnosis.loop.superfluous import fit_without
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.evidence import held_out_square
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from stribeck.effect.describe import is_friction
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.models.catalog import effect_row

#: What a free function may explain beyond an effect, as a share of what the effect explains.
BEYOND = 1 / 3
OTHER_FORM = (
    "a free function of the speed explains much more: friction depends on it in a way that no "
    "effect of the catalog describes"
)


def of_other_form(
    findings: Sequence[Finding], current: Fit, remains: Unexplained, seed: int
) -> list[str]:
    """The effects of the speed in a model that have another form, where structure remains."""
    if not remains.is_structure:
        return []
    of_speed = [f for f in findings if f.effect in current.model.effects and _is_of_speed(f.effect)]
    return [finding.effect for finding in of_speed if _beyond(finding, current, seed) > BEYOND]


def _is_of_speed(effect: str) -> bool:
    """Whether an effect is friction that depends on the velocity alone."""
    row = effect_row(effect)
    return is_friction(effect) and row is not None and not row["channels"]


def _beyond(finding: Finding, current: Fit, seed: int) -> float:
    """What a free function explains beyond an effect, as a share of what the effect explains."""
    columns = of_catalog(finding.effect).flexible_shape(current)
    without = fit_without(current, finding, seed) if columns else None
    if without is None:
        return 0.0
    free = FlexibleRefit.beside(current, np.column_stack(columns))
    square = held_out_square(current, current)
    explained = held_out_square(without, current) - square
    more = square - float(np.sum(free.held_out**2))
    return more / explained if explained > 0.0 else 0.0
