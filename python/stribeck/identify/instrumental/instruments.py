"""Instrumental variables from the reference trajectory of a controller.

Noise of the encoder enters velocity and acceleration, and through the controller the torque. The
columns of least squares are then correlated with its residual, and its parameters are biased. The
same columns evaluated along the reference trajectory are correlated with the motion, but not with
the noise. The parameters solve ``Z(x)' r(x) = 0`` with these columns Z and the residual r of the
measured motion (Janot, Vandanjon and Gautier 2014, "A generic instrumental variable approach for
industrial robot identification", IEEE Transactions on Control Systems Technology 22).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base import linear
from stribeck.base.errors import FitError
from stribeck.identify.problem import Problem
from stribeck.identify.search.separable import MOST_ROUNDS, Search, rounding
from stribeck.identify.triangle import Triangle, least_squares, triangles
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Samples are used where the reference is faster than this many times the threshold of the scored
#: samples: there, noise hardly decides which samples are scored.
CLEAR = 1.4
#: The iteration ends when a step is smaller than this share of the standard errors.
SETTLED = 1e-6
#: Directions of the instruments below this share of their length are rounding.
ROUNDING = 1e-9


@dataclass(frozen=True)
class Instruments:
    """A problem with its instruments: the same model on the reference motion, on the same rows."""

    problem: Problem
    along: Problem

    @classmethod
    def of(cls, problem: Problem, along: Recording, load: Array | None = None) -> Instruments:
        """With instruments along a reference motion.

        Parameters
        ----------
        along : Recording
            The `along_reference` of the recording of `problem`.
        load : array [n], optional
            Load torque of an identified rigid body along the reference, where friction reads it.
        """
        clear = np.abs(along.velocity) > CLEAR * problem.recording.velocity_threshold
        rows = problem.rows[clear[problem.rows]]
        on = replace(problem, rows=rows)
        return cls(on, replace(on, recording=along, load=load))

    def on(self, kept: NDArray[np.bool_]) -> Instruments:
        """The same on some of the rows."""
        rows = self.problem.rows[kept]
        return Instruments(replace(self.problem, rows=rows), replace(self.along, rows=rows))

    def linearise(self, values: Array, wanted: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """Residual [m], its columns J [m, k] and the instruments Z [m, k].

        Raises `FitError` if the law is not defined or not finite along the reference.
        """
        residual, jacobian = self.problem.linearise(values, wanted)
        where = (
            f"{self.problem.model.spec} along the reference trajectory of "
            f"{self.problem.recording.path}"
        )
        try:
            instruments = self.along.linearise(values, wanted)[1]
        except _core.ModelError as error:
            raise FitError(f"{where}: {error}") from None
        if not np.all(np.isfinite(instruments)):
            raise FitError(f"{where} is not finite: use another law, or fit by least squares")
        return residual, jacobian, instruments

    def search(self, values: Array, lower: Array, upper: Array) -> Search:
        """Solve ``Z' r = 0`` within bounds by Gauss-Newton steps from `values` [p].

        A step minimises the length of the residual's projection on the instruments, which is zero
        at the solution; the instruments are renewed after each step.
        """
        free = np.flatnonzero(lower < upper)
        values, square = values.copy(), np.inf
        for round_ in range(1, MOST_ROUNDS + 1):
            residual, jacobian, instruments = self.linearise(values, free)
            square = float(residual @ residual)
            factor, right = projected(instruments, jacobian, residual)
            step = least_squares(
                factor, right, lower[free] - values[free], upper[free] - values[free]
            )
            size = linear.length(factor @ step)
            noise = np.sqrt(square / max(residual.size, 1))
            if size <= max(SETTLED * noise, rounding(self.problem)):
                return Search(values, square, True, "converged", round_)
            values[free] = np.clip(
                values[free] + self._share(values, free, step, instruments, right) * step,
                lower[free],
                upper[free],
            )
        return Search(
            values, square, False, "the instrumental variables did not converge", MOST_ROUNDS
        )

    def _share(
        self, values: Array, free: NDArray[np.intp], step: Array, instruments: Array, right: Array
    ) -> float:
        """The largest of 1, 1/2, 1/4 ... of a step that shortens the projection."""
        share, before = 1.0, linear.length(right)
        while share > 1e-3:
            trial = values.copy()
            trial[free] += share * step
            residual = self.problem.linearise(trial, free[:0])[0]
            if np.all(np.isfinite(residual)):
                after = Triangle.of(instruments, residual).right
                if linear.length(after) < before:
                    break
            share *= 0.5
        return share

    def held_out(self, values: Array, lower: Array, upper: Array) -> Array:
        """Torque of every sample [n], predicted by a refit without the sample's block.

        Each refit takes two steps from the solution on all samples.
        """
        recording = self.problem.recording
        count, prediction = recording.block_count, self.problem.predict(values)
        if count < 2:
            return np.full_like(prediction, np.nan)
        block = recording.block[self.problem.rows]
        free = np.flatnonzero(lower < upper)
        parts = self._parts(values, free, block.astype(np.uint32), count)
        linear = all(p.linear for p in self.problem.model.parameters)
        for b in range(count):
            if not np.any(block == b):
                continue
            others = Triangle.joined([part for k, part in enumerate(parts) if k != b])
            refit = _stepped(others, values, free, lower, upper)
            if not linear:
                again = self.on(block != b)._parts(refit, free, None, 1)[0]
                refit = _stepped(again, refit, free, lower, upper)
            rows = np.flatnonzero(recording.block == b)
            prediction[rows] = self.problem.predict(refit, rows)
        return prediction

    def _parts(
        self,
        values: Array,
        free: NDArray[np.intp],
        group: NDArray[np.uint32] | None,
        groups: int,
    ) -> list[Triangle]:
        residual, jacobian, instruments = self.linearise(values, free)
        if group is None:
            group = np.zeros(residual.size, dtype=np.uint32)
        return triangles(np.hstack([instruments, jacobian]), residual, group, groups)


def _stepped(
    both: Triangle, values: Array, free: NDArray[np.intp], lower: Array, upper: Array
) -> Array:
    """Values [p] after one step, from the factor of ``[Z J]`` and the residual."""
    factor, right = projection(both)
    low, high = lower[free] - values[free], upper[free] - values[free]
    refit = values.copy()
    refit[free] = np.clip(
        values[free] + least_squares(factor, right, low, high), lower[free], upper[free]
    )
    return refit


def projected(instruments: Array, jacobian: Array, residual: Array) -> tuple[Array, Array]:
    """``Q'J`` [k, k] and ``Q'r`` [k], with Q an orthonormal basis of the instruments [m, k]."""
    return projection(Triangle.of(np.hstack([instruments, jacobian]), residual))


def projection(both: Triangle) -> tuple[Array, Array]:
    """As `projected`, from the factor of ``[Z J]`` and the residual.

    Rows of instruments that depend on those before them are rounding and are set to zero.
    """
    k = both.right.size // 2
    basis = both.factor[:k, :k]
    length = np.sqrt(np.einsum("ij,ij->j", basis, basis))
    real = np.abs(np.diag(basis)) > ROUNDING * length
    factor, right = both.factor[:k, k:], both.right[:k]
    return np.where(real[:, None], factor, 0.0), np.where(real, right, 0.0)


def fitted_columns(instruments: Array, jacobian: Array, residual: Array) -> Array:
    """Columns J [m, k] projected on the instruments Z [m, k]: ``Z (Z'Z)^-1 Z'J``.

    The errors of least squares with these columns in place of J are those of the instrumental
    variables: ``(Z'J)^-1 S (J'Z)^-1``.
    """
    both = Triangle.of(np.hstack([instruments, jacobian]), residual)
    k = jacobian.shape[1]
    open_ = np.full(k, np.inf)
    basis = both.factor[:k, :k]
    weights = [least_squares(basis, column, -open_, open_) for column in both.factor[:k, k:].T]
    return np.asarray(instruments @ np.stack(weights, axis=1))
