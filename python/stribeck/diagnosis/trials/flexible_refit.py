"""A model whose effects may take any smooth form: what it leaves for another effect."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.flexible_shape import flexible_columns
from stribeck.diagnosis.least_fall import reduced
from stribeck.diagnosis.trials.evidence import Difference, held_out_square
from stribeck.diagnosis.trials.trial import SIGNIFICANCE, TIE, Trial
from stribeck.fitting.result import Fit
from stribeck.identify.errors.added_torque import added_torque_test
from stribeck.identify.normal import NormalEquations, solve_bounded
from stribeck.identify.problem import Problem

Array = NDArray[np.float64]

#: Least share of what a trial explains that it explains beside a better flexible form as well.
KEPT = 0.25


@dataclass(frozen=True)
class Linearised:
    """A fit in linear form on its samples, with the weights of another.

    Attributes
    ----------
    residual : array [m]
        Measured minus predicted torque, weighted.
    jacobian : array [m, p]
        Derivatives of the prediction by the parameters, weighted.
    group : int array [m]
        Block of each sample.
    problem
        The fit with these weights.
    """

    residual: Array
    jacobian: Array
    group: NDArray[np.uint32]
    problem: Problem

    @classmethod
    def of(cls, fitted: Fit, before: Fit) -> Linearised:
        """That of `fitted`, with the weights of `before`, so that fits are compared alike."""
        problem = Problem(
            fitted.recording, fitted.model, fitted.rows, fitted.load, loss_weight=before.loss_weight
        )
        residual, jacobian = map(problem.weighted, problem.linearise(fitted.model.values))
        group = fitted.recording.block[fitted.rows].astype(np.uint32)
        return cls(residual, jacobian, group, problem)

    def refit(self, extra: Array, least: Array) -> tuple[Array, Array]:
        """Held-out and in-sample residuals [m], weighted, with `extra` columns [m, k] added.

        The `least` factors [k] of these columns are zero or minus infinity.
        """
        residual, group = self.residual, self.group
        columns = np.column_stack([self.jacobian, self.problem.weighted(extra)])
        size = np.sqrt((columns**2).mean(axis=0))
        columns = np.ascontiguousarray(columns[:, size > 0] / size[size > 0])
        sums = NormalEquations.of(columns, residual, group)
        matrix, vector = sums.total()
        lower = np.concatenate([np.full(self.jacobian.shape[1], -np.inf), least])[size > 0]
        free = np.full(columns.shape[1], np.inf)
        # A small ridge bounds columns that only one block determines, in the refit without it.
        ridge = 1e-6 * residual.size * np.eye(columns.shape[1])
        held_out = residual.copy()
        for b in range(sums.square.size):
            step = solve_bounded(
                matrix - sums.matrix[b] + ridge, vector - sums.vector[b], lower, free
            )
            rows = group == b
            held_out[rows] = residual[rows] - columns[rows] @ step
        step = solve_bounded(matrix + ridge, vector, lower, free)
        return held_out, residual - columns @ step


@dataclass(frozen=True)
class FlexibleRefit:
    """A fit whose effects may take any smooth form.

    Attributes
    ----------
    before
        The fit.
    linearised
        Its linear form.
    columns : array [m, k]
        Columns that let its effects do so, on its samples.
    least : array [k]
        The least factor of each column.
    held_out, residual : array [m]
        Residual of the refits without each block, and of the refit to all samples. In a block that
        it predicts worse than the fit does, such as the only cold one, the first is that of the
        fit: there it would extrapolate.
    """

    before: Fit
    linearised: Linearised
    columns: Array
    least: Array
    held_out: Array
    residual: Array

    @classmethod
    def of(cls, before: Fit) -> FlexibleRefit | None:
        """The most flexible form; None where no effect of the fit has one."""
        columns = flexible_columns(before)
        return cls.beside(before, columns) if columns.shape[1] else None

    @classmethod
    def beside(cls, before: Fit, columns: Array, least: Array | None = None) -> FlexibleRefit:
        """A fit with given columns [m, k], and their least factors; default: any."""
        return cls._made(before, Linearised.of(before, before), columns, least)

    def instead(self, columns: Array, least: Array | None = None) -> FlexibleRefit:
        """The same fit with other columns."""
        return self._made(self.before, self.linearised, columns, least)

    @classmethod
    def _made(
        cls, before: Fit, linearised: Linearised, columns: Array, least: Array | None
    ) -> FlexibleRefit:
        least = _any(columns) if least is None else least
        held_out, residual = linearised.refit(columns, least)
        held_out = _no_worse(held_out, before, before)
        return cls(before, linearised, columns, least, held_out, residual)

    def explains(self, trial: Trial, tried: int, least: float) -> bool:
        """Whether a trial among `tried`, which must bring the fall `least`, no longer passes.

        One that predicts better than the flexible form by two standard errors is not explained. One
        that predicts worse by as much is where it hardly explains anything beside that form.
        """
        advantage = self.advantage(trial)
        if advantage > TIE:
            return False
        fall, p_value = self.beside_columns(trial)
        if fall < reduced(least) or p_value * tried > SIGNIFICANCE:
            return True
        kept = float(np.sum(self.held_out**2)) * (1.0 - (1.0 - fall) ** 2)
        alone = held_out_square(self.before, self.before) - held_out_square(trial.fit, self.before)
        return advantage < -TIE and kept < KEPT * alone

    def advantage(self, trial: Trial) -> float:
        """Standard errors by which the columns leave a larger held-out error than a trial."""
        own: Array = self.before.weighted(trial.fit.held_out_residual[self.before.rows]) ** 2
        found = Difference.of(self.held_out**2 - own)
        return found.total / found.error if found.error > 0 else 0.0

    def beside_columns(self, trial: Trial) -> tuple[float, float]:
        """What a trial adds to the columns: relative fall of the held-out RMSE, and p-value."""
        linearised = Linearised.of(trial.fit, self.before)
        along, residual_along = linearised.refit(self.columns, self.least)
        along = _no_worse(along, trial.fit, self.before)
        level = float(np.mean(self.held_out**2))
        fall = 1.0 - float(np.sqrt(np.mean(along**2) / level)) if level > 0 else 0.0
        p_value = added_torque_test(
            self.residual - residual_along,
            residual_along,
            len(trial.fit.model.names) - len(self.before.model.names),
        )
        return fall, p_value


def free_square(fitted: Fit) -> Array:
    """Squared held-out residual [m] of a fit, weighted, its effects in their free forms."""
    free = FlexibleRefit.of(fitted)
    if free is not None:
        return free.held_out**2
    return np.asarray(fitted.weighted(fitted.held_out_residual[fitted.rows]) ** 2)


def free_difference(worse: Fit, better: Fit) -> Difference:
    """Compare two models, the effects of both in their free forms, on held-out samples."""
    return Difference.of(free_square(worse) - free_square(better))


def _no_worse(held_out: Array, fitted: Fit, before: Fit) -> Array:
    """Held-out residuals [m], but those of `fitted` in the blocks that it predicts better."""
    plain = before.weighted(fitted.held_out_residual[fitted.rows])
    block = fitted.recording.block[fitted.rows]
    worse = np.bincount(block, held_out**2) > np.bincount(block, plain**2)
    return np.where(worse[block], plain, held_out)


def held_out_with_columns(fitted: Fit, extra: Array, before: Fit) -> Array:
    """Held-out residual of `fitted` [m], linearised, with columns [m, k] added.

    With the weights of `before`, so that fits are compared with the same weights.
    """
    return Linearised.of(fitted, before).refit(extra, _any(extra))[0]


def _any(columns: Array) -> Array:
    """The least factors [k] of columns that may have any."""
    return np.full(columns.shape[1], -np.inf)
