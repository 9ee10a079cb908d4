"""Friction effects of another form: a free function of the motion explains clearly more.

A step of friction in a band of speed is imitated in part by a Stribeck curve. What the curve leaves
is a function of the speed as well. Of the right effect its law leaves little to a free function.

Friction always depends on the speed and may depend on the position, so that the form alone tells
such effects apart. One that reads a channel of its own, such as the load torque, is another matter:
a free function of that channel which explains more confirms that friction depends on it.

A filter of the torque acts where the speed is low, so that a free function of the speed explains a
part of what it leaves. Where causes in the measurement explain most of what remains, the form of an
effect is not in doubt.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stribeck.diagnosis.loop.superfluous import fit_without
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.evidence import held_out_square
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from stribeck.diagnosis.trials.imitations import explained_by_causes
from stribeck.effect.base import FreeForm
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit

#: What a free function may explain beyond an effect, as a share of what the effect explains. Laws
#: are not exact either: right effects leave up to 0.11, on simulated and on real recordings, and
#: imitations from 0.2 on.
BEYOND = 0.15
#: Causes in the measurement explain most of what remains: more than this share of its square. What
#: an imitation leaves they explain by at most 0.3.
MOST = 0.5


def of_other_form(
    findings: Sequence[Finding], current: Fit, remains: Unexplained, seed: int
) -> dict[str, str]:
    """The effects of a model that have another form, where structure remains, and why."""
    if not remains.is_structure:
        return {}
    doubtful = {
        finding.effect: (
            f"a free function of {form.of} explains clearly more: friction depends on it in a way "
            "that no effect of the catalog describes"
        )
        for finding in findings
        if finding.effect in current.model.effects
        and (form := of_catalog(finding.effect).free_form) is not None
        and _beyond(finding, form, current, seed) > BEYOND
    }
    return doubtful if doubtful and explained_by_causes(current) <= MOST else {}


def _beyond(finding: Finding, form: FreeForm, current: Fit, seed: int) -> float:
    """What a free function explains beyond an effect, as a share of what the effect explains."""
    columns = form.columns(current)
    without = fit_without(current, finding, seed) if columns else None
    if without is None:
        return 0.0
    free = FlexibleRefit.beside(current, np.column_stack(columns))
    square = held_out_square(current, current)
    explained = held_out_square(without, current) - square
    more = square - float(np.sum(free.held_out**2))
    return more / explained if explained > 0.0 else 0.0
