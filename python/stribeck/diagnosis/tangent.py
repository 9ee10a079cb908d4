"""The torque that an effect would add to a model on given rows, and which torques it can make.

An effect that is not in a model shows in the prediction as a direction in the space of all rows:
the torque that it adds for one unit of its size. What lies in the span of the model's own
directions is taken up by a refit and shows nowhere; only the rest can be seen.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import FitError
from stribeck.diagnosis.widen import widening
from stribeck.effect.registry import find
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import check_channels, scaled_parameters
from stribeck.identify.triangle import UNSEEN, Triangle
from stribeck.models.parameter import Parameter

Array = NDArray[np.float64]

#: Rows on which angles between effects and leverages are taken; they need no noise.
MOST_ROWS = 8000
#: Multiples of the start at which an effect's first nonlinear parameter is looked at too.
OTHER_STARTS = (1.0 / 3.0, 3.0)


@dataclass(frozen=True)
class Beside:
    """A model on some rows, as the span of what a refit of it can take up.

    Parameters
    ----------
    problem
        Its model has values.
    extra : array [m, k]
        Further columns that count as part of the model.
    """

    problem: Problem
    extra: Array | None = None

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Parameters that a fit may change, int array [p]."""
        model = self.problem.model
        held = {name for name, (low, high) in model.bounds.items() if low == high}
        return np.flatnonzero([name not in held for name in model.names])

    @cached_property
    def columns(self) -> Array:
        """Derivative of the prediction by each free parameter, and the extra columns, [m, p]."""
        _, jacobian = self.problem.linearise(self.problem.model.values, self.free)
        return jacobian if self.extra is None else np.column_stack([jacobian, self.extra])

    @cached_property
    def basis(self) -> Array:
        """Orthonormal basis of the columns' span, [m, r]."""
        return orthonormal(self.columns)

    @property
    def step(self) -> int:
        """One row in so many is enough for angles and leverages."""
        return -(-self.problem.rows.size // MOST_ROWS)

    @cached_property
    def few(self) -> Array:
        """Orthonormal basis of the columns' span on one row in `step`."""
        return orthonormal(self.columns[:: self.step])

    def without(self, torques: Array) -> Array:
        """The part of `torques` [m, k] that no refit takes up."""
        return rest(self.basis, torques)


def orthonormal(columns: Array) -> Array:
    """Orthonormal basis [m, r] of the span of `columns` [m, k].

    Examples
    --------
    >>> orthonormal(np.array([[3.0, 6.0], [4.0, 8.0]])).shape
    (2, 1)
    """
    basis = columns
    # The second time restores what rounding took from nearly dependent columns.
    for _ in range(2):
        size = np.sqrt(np.einsum("ij,ij->j", basis, basis))
        basis = basis[:, size > 0] / size[size > 0]
        factor = Triangle.of(basis, np.zeros(basis.shape[0])).factor
        _, weights, vectors = np.linalg.svd(factor)
        kept = weights > UNSEEN * weights.max(initial=0.0)
        basis = basis @ (vectors[kept].T / weights[kept])
    return basis


def rest(basis: Array, torques: Array) -> Array:
    """The part of `torques` [m, k] outside the span of an orthonormal `basis` [m, r].

    Examples
    --------
    >>> rest(np.array([[0.6], [0.8]]), np.array([[3.0], [4.0]])).round(12)
    array([[0.],
           [0.]])
    """
    left = torques - basis @ (basis.T @ torques)
    return left - basis @ (basis.T @ left)


@dataclass(frozen=True)
class Widened:
    """A model with one effect added, at the effect's start.

    Attributes
    ----------
    problem
        The wider model at values where its effect is there, on the same rows.
    own
        Indices of the effect's parameters, the size first, int array [p].
    simpler
        Indices of the parameters of the simpler effect that it contains and the model lacks.
    parameters
        The effect's parameters, scaled to the recording.
    """

    effect: str
    problem: Problem
    own: NDArray[np.intp]
    simpler: NDArray[np.intp]
    parameters: tuple[Parameter, ...]

    @classmethod
    def of(cls, before: Problem, effect: str, residual: Array | None = None) -> Widened:
        """Add `effect` to the model of `before`.

        Parameters
        ----------
        residual : array [n]
            What the model leaves, of every row of the recording; a ripple's period is found in it.

        Raises
        ------
        SpecError, FitError
            The model cannot take the effect, or the recording lacks a channel for it.
        """
        recording = before.recording
        models = widening(before.model, effect, recording, before.load, residual)
        wider = models[-1]
        check_channels(wider, recording)
        rows = scaled_parameters(wider, recording)
        start = np.array([row.start for row in rows])
        values = np.where(np.isfinite(wider.values), wider.values, start)
        new = [[n for n in b.names if n not in a.names] for a, b in itertools.pairwise(models)]
        index = {name: k for k, name in enumerate(wider.names)}
        own = np.array([index[n] for n in new[-1]], dtype=np.intp)
        between = np.array([index[n] for names in new[:-1] for n in names], dtype=np.intp)
        problem = Problem(recording, wider.with_values(values), before.rows, before.load)
        return cls(effect, problem, own, between, tuple(rows[k] for k in own))

    def on(self, problem: Problem) -> Widened:
        """The same wider model on the rows of another recording, that of `problem`."""
        return replace(self, problem=replace(problem, model=self.problem.model))

    @property
    def size(self) -> Parameter:
        """The parameter that says how large the effect is."""
        return self.parameters[0]

    @property
    def size_range(self) -> tuple[float, float] | None:
        """Where the torque is not proportional to the size: multiples of its start, large first."""
        known = find(self.effect)
        return None if known is None else known.size_range

    @property
    def is_curved(self) -> bool:
        """Whether the torque is not proportional to the size."""
        return self.size_range is not None

    @property
    def is_inverse(self) -> bool:
        """Whether the effect is the smaller the larger its size: a bristle's stiffness."""
        return self.size_range is not None and self.size_range[1] > 1.0

    def at(self, size: float) -> Array:
        """Values of the wider model [p] with this size of the effect."""
        values = self.problem.model.values.copy()
        values[self.own[0]] = size
        return values

    def unit_torque(self) -> Array:
        """Torque on the rows for one unit of the size, array [m], the others at their starts."""
        return self._at_start[:, 0]

    def own_columns(self, torque: Array) -> Array:
        """What a fit of the effect can take up where it adds `torque` [m], array [m, k]."""
        return torque[:, None] if self.is_curved else self._at_start[:, : self.own.size]

    def simpler_columns(self) -> Array:
        """What the simpler effect can take up, array [m, k]; none where there is none."""
        return self._at_start[:, self.own.size :]

    @cached_property
    def _at_start(self) -> Array:
        """Derivative of the prediction by the parameters `own` and `simpler`, array [m, p]."""
        return self._columns(self.problem, self.problem.model.values)

    def spaces(self, step: int) -> list[Array]:
        """Spans of the torques that the effect can make near each of a few starts.

        Parameters
        ----------
        step
            One row in so many is enough.

        Returns
        -------
        list of arrays [m / step, k]
        """
        if self.is_curved:
            changes = [self.change(size)[::step, None] for size in self.sizes(3)]
            return [np.concatenate([*changes, self.simpler_columns()[::step]], axis=1)]
        few = replace(self.problem, rows=self.problem.rows[::step])
        return [self._at_start[::step], *(self._columns(few, v) for v in self._other_starts())]

    def _columns(self, problem: Problem, values: Array) -> Array:
        wanted = np.concatenate([self.own, self.simpler])
        try:
            _, columns = problem.linearise(values, np.sort(wanted))
        except _core.ModelError as error:
            raise FitError(f"{self.effect} cannot be added: {error}") from None
        return _finite(columns[:, np.argsort(np.argsort(wanted))], self.effect)

    def _other_starts(self) -> list[Array]:
        """Values of the wider model with the effect's first nonlinear parameter elsewhere."""
        first = self.problem.model.values
        bends = [k for k, p in enumerate(self.parameters) if k > 0 and p.role == "nonlinear"]
        starts = []
        for share in OTHER_STARTS if bends else ():
            k = bends[0]
            row, values = self.parameters[k], first.copy()
            values[self.own[k]] = np.clip(first[self.own[k]] * share, row.lower, row.upper)
            if values[self.own[k]] != first[self.own[k]]:
                starts.append(values)
        return starts

    def sizes(self, count: int) -> list[float]:
        """Sizes of an effect that `is_curved`, from large effects to small ones."""
        assert self.size_range is not None
        row = self.size
        ends = np.clip(row.start * np.array(self.size_range), row.lower, row.upper)
        return [float(size) for size in np.geomspace(float(ends[0]), float(ends[1]), count)]

    @cached_property
    def absent(self) -> Array:
        """Torque of the wider model on the rows with as little of the effect as it can have, [m].

        Not quite the torque of the model without it: a bristle, however hard, turns when its
        deflection does, and not with the sign of the velocity.
        """
        size = self.size.upper if self.is_inverse else self.size.lower
        return self._torque(size)

    def change(self, size: float) -> Array:
        """Torque that the effect of this size adds on the rows, array [m]."""
        return self._torque(size) - self.absent

    def _torque(self, size: float) -> Array:
        return _finite(self.problem.predict(self.at(size))[self.problem.rows], self.effect)


def _finite(torque: Array, effect: str) -> Array:
    if not np.all(np.isfinite(torque)):
        raise FitError(f"{effect} has no finite torque at its start on this data")
    return torque


def sine(torque: Array, basis: Array) -> float:
    """Sine of the angle between `torque` [m] and the span of an orthonormal `basis` [m, r].

    Examples
    --------
    >>> sine(np.array([1.0, 1.0]), np.array([[1.0], [0.0]])).__round__(6)
    0.707107
    """
    length = float(np.linalg.norm(torque))
    if length == 0.0:
        return 0.0
    return float(np.linalg.norm(rest(basis, torque[:, None]))) / length


__all__ = ["Beside", "Widened", "orthonormal", "rest", "sine"]
