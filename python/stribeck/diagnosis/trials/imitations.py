"""Friction effects that causes in the measurement explain as well.

A filter, a lag, an amplifier that warms up or a wrong scale of the load leaves errors that friction
can imitate. A friction effect stands if it explains something beside the columns of all these
causes, or predicts better than they do. Otherwise it is not claimed where they predict better, and
demoted where both do equally well.
"""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.measurement.table import least_factors, measurement_columns
from stribeck.diagnosis.trials.evidence import Difference
from stribeck.diagnosis.trials.flexible_refit import Array, FlexibleRefit
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, TIE, Trial
from stribeck.effect.describe import is_friction
from stribeck.fitting.result import Fit


def without_imitations(before: Fit, sift: Sifted, tried: int, least: float) -> Sifted:
    """The same without friction effects that causes in the measurement explain as well."""
    suspects = [t for t in sift.stand if is_friction(t.effect)]
    columns = measurement_columns(before) if suspects else {}
    if not columns:
        return sift
    alone = {
        what: FlexibleRefit.beside(before, made, least_factors({what: made}))
        for what, made in columns.items()
    }
    every = np.column_stack(list(columns.values()))
    together = FlexibleRefit.beside(before, every, least_factors(columns))
    for trial in suspects:
        better = _advantage(before, together, trial)
        if better < -TIE:
            continue
        fall, p_value = together.beside_columns(trial)
        # An effect that predicts better than all the causes need not add much to them.
        needed = least / 2 if better > 0 else 0.0
        if fall >= needed and p_value * tried <= SIGNIFICANCE:
            continue
        cause = _largest(alone)
        if better > TIE:
            doubted = Doubted(trial, f"{cause} explains more, and what it explains too")
            sift = sift.instead(trial, Sifted(refused=(doubted,)))
        else:
            doubted = Doubted(trial, f"{cause} explains it as well")
            sift = sift.instead(trial, Sifted(demoted=(doubted,)))
    return sift


def _largest(alone: dict[str, FlexibleRefit]) -> str:
    """The cause that alone leaves the smallest held-out error."""
    return min(alone, key=lambda what: float(np.sum(alone[what].held_out ** 2)))


def _advantage(before: Fit, columns: FlexibleRefit, trial: Trial) -> float:
    """Standard errors by which the columns leave a smaller held-out error than a trial."""
    own: Array = before.weighted(trial.fit.held_out_residual[before.rows]) ** 2
    found = Difference.of(own - columns.held_out**2)
    return found.total / found.error if found.error > 0 else 0.0
