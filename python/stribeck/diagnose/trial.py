"""Try one effect: refit with it, and weigh the evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from stribeck.diagnose.evidence import Comparison, compare_fits, compare_squares
from stribeck.diagnose.shape import flexible_columns
from stribeck.errors import StribeckError
from stribeck.fit import Fit, fit, own_load
from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import effect_constants

#: Starts of an effect's nonlinear parameters; the others start from the fit before.
STARTS = 6
#: A finding's probability of being chance, over all effects tried together.
SIGNIFICANCE = 0.01
#: Held-out errors within so many standard errors of their difference are a tie.
TIE = 1.0


@dataclass(frozen=True)
class Trial:
    """One effect added to a model and fitted.

    Attributes
    ----------
    comparison
        Against the model without the effect.
    is_shape
        Whether the effects already in the model, let free in form, do as well.
    """

    effect: str
    fit: Fit
    comparison: Comparison
    is_shape: bool = False

    @property
    def parameters(self) -> int:
        """Number of parameters of the wider model."""
        return len(self.fit.model.names)

    @property
    def square(self) -> float:
        """Held-out sum of squares on the rows fitted to."""
        return float(np.sum(self.fit.held_out_residual[self.fit.rows] ** 2))


def add_effect(before: Fit, effect: str, *, starts: int = STARTS, seed: int = 0) -> Fit:
    """Refit `before`'s model with `effect` added, starting from what is known.

    Raises
    ------
    SpecError, FitError
        The effect is in the model already, or needs a channel that is not there.
    """
    load = own_load(before.model, before.recording)
    constants = effect_constants(effect, before.recording, load)
    wider = before.model.with_effect(effect, constants)
    return fit(
        wider, before.recording, starts=starts, seed=seed, transient=before.transient
    )


def try_effect(before: Fit, effect: str, *, seed: int = 0) -> Trial | None:
    """Try `effect`; None where the model cannot take it."""
    try:
        after = add_effect(before, effect, seed=seed)
    except StribeckError:
        return None
    if after.rmse_held_out is None or before.rmse_held_out is None:
        return None
    return Trial(effect, after, compare_fits(before, after))


def passes(trial: Trial, tried: int, least: float) -> bool:
    """Whether a trial is evidence: it matters, and it is not chance among `tried` effects."""
    before = trial.comparison
    return before.fall >= least and before.p_value * tried <= SIGNIFICANCE


def tie_statistic(best: Trial, other: Trial) -> float:
    """Standard errors by which `other`'s held-out error exceeds `best`'s."""
    comparison = compare_fits(other.fit, best.fit)
    if comparison.difference <= 0:
        return 0.0
    return comparison.difference / comparison.error if comparison.error > 0 else np.inf


def tie_weight(statistic: float) -> float:
    """Two-sided probability of a difference at least this large by chance."""
    return float(2.0 * norm.sf(abs(statistic)))


def explained_by_shape(before: Fit, trial: Trial, tried: int, least: float) -> bool:
    """Whether a freer form of the effects already in `before` leaves nothing to `trial`."""
    extra = flexible_columns(before)
    if extra.shape[1] == 0:
        return False
    with_extra = _held_out_linear(before, extra)
    with_both = _held_out_linear(trial.fit, extra)
    comparison = compare_squares(
        with_extra, with_both, before.recording.segment[before.rows]
    )
    return not (comparison.fall >= least / 2 and comparison.p_value * tried <= SIGNIFICANCE)


def _held_out_linear(fitted: Fit, extra: np.ndarray) -> np.ndarray:
    """Held-out residuals of `fitted` linearised, with `extra` columns added, on its rows."""
    problem = Problem(fitted.recording, fitted.model, fitted.rows, fitted.load)
    residual, jacobian = problem.linearise(fitted.model.values)
    columns = np.column_stack([jacobian, extra])
    size = np.sqrt((columns**2).mean(axis=0))
    columns = np.ascontiguousarray(columns[:, size > 0] / size[size > 0])
    group = fitted.recording.block[fitted.rows].astype(np.uint32)
    sums = NormalEquations.of(columns, residual, group)
    matrix, vector = sums.total()
    free = np.full(columns.shape[1], np.inf)
    # A trace of ridge keeps columns that only one block shows from running away in its refit.
    ridge = 1e-6 * residual.size * np.eye(columns.shape[1])
    held_out = residual.copy()
    for b in range(sums.square.size):
        step = solve_bounded(matrix - sums.matrix[b] + ridge, vector - sums.vector[b], -free, free)
        rows = group == b
        held_out[rows] = residual[rows] - columns[rows] @ step
    return held_out
